// The exported functions of an adaptor library (adaptor_door.h), for one world of the process.

#include <exception>
#include <memory>

#include "tandem/bullet_bridge/bullet_abi.h"

#include "preload/adaptor_door.h"
#include "preload/interposer/say.h"
#include "shared_object.h"

namespace tandem::preload {
namespace {

/// Never destroyed: a static world may end after every other object here.
struct State {
  PreloadConfig config;
  std::unique_ptr<SharedObject> shared;
};
State& state() {
  static State& only = *new State;
  return only;
}

const char* nameOfWidth(std::size_t bytes) {
  return bytes == sizeof(double) ? "8-byte (double)" : "4-byte (float)";
}

/// Checks `process`, which the interposer has read with its own parser.
void checkProcess(const std::string& wanted, const char* config, const char* process) {
  if (wanted.empty() || wanted == process) return;
  throw Error(std::string(config) + ": process = \"" + wanted +
              "\": must be, before the first table,"
              " a line of its own and nothing but a name in quotes");
}

void checkWidth(std::size_t wanted, const char* config) {
  if (wanted == 0 || wanted == sizeof(btScalar)) return;
  throw Error(std::string("Bullet scalar width mismatch: this program's Bullet has ") +
              nameOfWidth(sizeof(btScalar)) + " btScalar, " + config + " asks for " +
              nameOfWidth(wanted));
}

std::size_t scalarBytes() { return sizeof(btScalar); }

bool open(const char* config, const char* process) {
  try {
    PreloadConfig& read = state().config;
    read = readPreloadConfig(config);
    checkProcess(read.process, config, process);
    checkWidth(read.scalar_bytes, config);
    checkBulletAbi(bulletAbiOfThisCode());
    state().shared = std::make_unique<SharedObject>(read);
    return true;
  } catch (const std::exception& error) {
    say("%s; %s runs on without Tandem", error.what(), process);
    return false;
  }
}

bool takeWorld(void* world, int number) {
  if (number != state().config.world || !state().shared) return false;
  state().shared->setWorld(*static_cast<btDiscreteDynamicsWorld*>(world));
  return true;
}

void beforeStep() { state().shared->beforeStep(); }

void afterStep(double dt, int max_sub_steps, double fixed_step, int sub_steps) {
  state().shared->afterStep(dt, max_sub_steps, fixed_step, sub_steps);
}

void objectLeaves(void* object) { state().shared->objectLeaves(object); }

void endWorld() {
  state().shared->endWorld();
  state().shared.reset();
}

}  // namespace
}  // namespace tandem::preload

using namespace tandem::preload;

extern "C" [[gnu::visibility("default")]] const TandemPreloadDoor tandemPreloadDoor1 = {
    &scalarBytes, &open, &takeWorld, &beforeStep, &afterStep, &objectLeaves, &endWorld};
