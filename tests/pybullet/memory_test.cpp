// A tick without memory: the server is C, so no exception may reach it.

#include <cmath>
#include <new>

#include <gtest/gtest.h>

#include "plugin/doors/pybullet/session.h"
#include "stub_engine.h"

namespace tandem::test {
namespace {

b3::Status (*submit)(b3::Client, b3::Command) = nullptr;
bool has_memory = true;

b3::Status submitWithMemory(b3::Client client, b3::Command command) {
  if (!has_memory) throw std::bad_alloc();
  return submit(client, command);
}

struct OpenSession {
  StubEngine engine;
  pybullet::Session session;

  OpenSession() : session(findFunctions(), engine.client()) {
    const double start[3]{10.0, 0.0, 0.0};
    TandemDevice* device = nullptr;
    EXPECT_EQ(tandem_device_create_moved(start, {HUGE_VAL, HUGE_VAL}, &device), TANDEM_OK);
    session.takeDevice(pybullet::DeviceHandle(device), true);
    session.openSite(tandem_default_site_settings());
    session.share(engine.add(makeStubCube()), 0.0, nullptr);
  }
  static pybullet::B3Functions findFunctions() {
    has_memory = true;
    pybullet::B3Functions functions;
    EXPECT_EQ(
        pybullet::findB3Functions(reinterpret_cast<const void*>(&submitWithMemory), functions), "");
    submit = functions.submit;
    functions.submit = &submitWithMemory;
    return functions;
  }
  void expectEnd() {
    has_memory = true;
    pybullet::SessionReading reading;
    session.read(reading);
    EXPECT_TRUE(reading.has_ended);
    EXPECT_NE(session.warnings().find("out of memory: the site has ended"), std::string::npos);
    session.close();
    EXPECT_EQ(engine.bodies.at(0).mass, 0.2);
  }
};

TEST(TickWithoutMemory, EndsTheSiteBeforeAStep) {
  OpenSession open;
  has_memory = false;
  open.session.preTick();
  open.expectEnd();
}

TEST(TickWithoutMemory, EndsTheSiteAfterAStep) {
  OpenSession open;
  open.session.preTick();
  has_memory = false;
  open.session.postTick();
  open.session.postTick();  // does nothing for a site that has ended
  open.expectEnd();
}

}  // namespace
}  // namespace tandem::test
