#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "tandem/falcon/gamepad_device.h"
#include "tandem/falcon/hid_switch.h"
#include "tandem/falcon/raw_hid_device.h"
#include "tandem/falcon/space_mouse_device.h"

#include "devices/fake_event_port.h"
#include "devices/raw_hid_emulator.h"

// This program replaces operator new and counts per thread. Not in sanitizer builds, which own the
// allocator.

namespace {

thread_local std::uint64_t allocations = 0;

void* allocate(std::size_t size) {
  ++allocations;
  if (void* const room = std::malloc(size)) return room;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void operator delete(void* room) noexcept { std::free(room); }
void operator delete[](void* room) noexcept { std::free(room); }
void operator delete(void* room, std::size_t) noexcept { std::free(room); }
void operator delete[](void* room, std::size_t) noexcept { std::free(room); }

namespace tandem {
namespace {

using test::comesTrue;

/// Allocations of this thread while it does 10,000 ticks.
template <typename Tick>
std::uint64_t countIn(Tick tick) {
  const std::uint64_t before = allocations;
  for (int i = 0; i < 10'000; ++i) tick(1e-3 * i);
  return allocations - before;
}

/// Reads and writes the device, whose clock runs at `pace`. Each reading must be valid.
void expectNoAllocationInTicks(HapticDevice& device, double pace = 1.0) {
  bool is_valid = true;
  EXPECT_EQ(countIn([&](double time) {
              is_valid = device.read(pace * time).valid && is_valid;
              device.write(Vec3(1, 2, 3));
            }),
            0U);
  EXPECT_TRUE(is_valid);
}

TEST(HidAllocation, TheCounterSeesOne) {
  static std::unique_ptr<double> kept;  // stored, so that the compiler cannot omit it
  EXPECT_EQ(countIn([](double time) { kept = std::make_unique<double>(time); }), 10'000U);
}

TEST(HidAllocation, ATickOfASpaceMouseDoesNone) {
  test::FakeHidDevice fake;
  SpaceMouseDevice device(fake.opener());
  fake.send({1, 0x5E, 0x01, 0, 0, 0, 0});
  ASSERT_TRUE(comesTrue([&] { return device.status().counters.reports == 1; }));
  expectNoAllocationInTicks(device);
}

TEST(HidAllocation, ATickOfARawHidDeviceDoesNone) {
  test::FakeHidDevice fake;
  test::RawHidEmulator emulator;
  emulator.holdAt(Vec3(0.0, 0.0, 0.125));
  RawHidDevice device(fake.opener());
  fake.send(emulator.next());
  ASSERT_TRUE(comesTrue([&] { return device.status().counters.reports == 1; }));
  expectNoAllocationInTicks(device, 1e-3);  // within 20 ms
}

TEST(HidAllocation, ATickOfAGamepadDoesNone) {
  test::FakeEventDevice fake;
  test::FakeEventDevice::makePad(fake);
  GamepadDevice device(fake.opener());
  fake.tell(EV_ABS, ABS_X, 32767);
  ASSERT_TRUE(comesTrue([&] { return device.status().counters.reports == 1; }));
  expectNoAllocationInTicks(device);
}

TEST(HidAllocation, ALookAtASwitchDoesNone) {
  test::FakeHidDevice fake;
  HidSwitch pedal(fake.opener(), {});
  bool is_pressed = false;
  EXPECT_EQ(countIn([&](double) { is_pressed = pedal.isPressed() || is_pressed; }), 0U);
  EXPECT_FALSE(is_pressed);
}

}  // namespace
}  // namespace tandem
