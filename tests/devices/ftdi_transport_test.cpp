// Records the calls to libftdi1. The linker finds these functions first.

#include <algorithm>
#include <deque>
#include <string>
#include <vector>

#include <ftdi.h>
#include <gtest/gtest.h>

#include "tandem/coordination/types.h"
#include "tandem/falcon/byte_transport.h"

namespace tandem {
namespace {

constexpr int kGone = -4, kTimedOut = -7;  // errors of libusb

/// State of the fake chip, and the calls it received.
struct FakeFtdi {
  int open_result = 0;
  int read_result = 0, write_result = 0;  ///< negative: fail with this
  std::deque<std::vector<unsigned char>>
      packets;  ///< delivered by transfers; empty packets after the last
  std::vector<unsigned char> buffered, sent;
  int transfers = 0;
  std::vector<std::string> asked;
};
FakeFtdi fake;

int note(const std::string& what) {
  fake.asked.push_back(what);
  return 0;
}

}  // namespace
}  // namespace tandem

using tandem::fake;
using tandem::note;

extern "C" {

ftdi_context* ftdi_new() { return new ftdi_context(); }
void ftdi_free(ftdi_context* context) { delete context; }
const char* ftdi_get_error_string(ftdi_context*) { return "some words"; }
int ftdi_set_interface(ftdi_context*, ftdi_interface) { return 0; }
int ftdi_usb_open_desc_index(ftdi_context*, int, int, const char*, const char*, unsigned) {
  return fake.open_result;
}
int ftdi_set_baudrate(ftdi_context*, int baud) { return note("baud " + std::to_string(baud)); }
int ftdi_set_line_property(ftdi_context*, ftdi_bits_type, ftdi_stopbits_type, ftdi_parity_type) {
  return note("8N1");
}
int ftdi_setflowctrl(ftdi_context*, int) { return note("flow"); }
int ftdi_set_latency_timer(ftdi_context*, unsigned char time) {
  return note("latency " + std::to_string(time));
}
int ftdi_setrts(ftdi_context*, int state) { return note("rts " + std::to_string(state)); }
int ftdi_setdtr(ftdi_context*, int state) { return note("dtr " + std::to_string(state)); }
int ftdi_tcioflush(ftdi_context*) { return note("flush"); }

int ftdi_write_data(ftdi_context*, const unsigned char* bytes, int size) {
  if (fake.write_result < 0) return fake.write_result;
  fake.sent.insert(fake.sent.end(), bytes, bytes + size);
  return size;
}

/// Like the library's: transfers continue until all requested bytes have arrived, or one is empty.
int ftdi_read_data(ftdi_context* context, unsigned char* bytes, int size) {
  if (fake.read_result < 0) return fake.read_result;
  int count = 0;
  for (;;) {
    const int taken = std::min(size - count, static_cast<int>(fake.buffered.size()));
    std::copy_n(fake.buffered.begin(), taken, bytes + count);
    fake.buffered.erase(fake.buffered.begin(), fake.buffered.begin() + taken);
    context->readbuffer_remaining = static_cast<unsigned>(fake.buffered.size());
    count += taken;
    if (count == size) return count;
    ++fake.transfers;
    if (fake.packets.empty()) return count;
    fake.buffered = fake.packets.front();
    fake.packets.pop_front();
  }
}
}

namespace tandem {
namespace {

class FtdiTransport : public ::testing::Test {
 protected:
  std::ptrdiff_t read(std::size_t room = 256) { return line_->read(bytes_.data(), room, 0.0); }

  std::unique_ptr<ByteTransport> line_ = [] {
    fake = {};
    return openFtdi();
  }();
  std::array<std::uint8_t, 256> bytes_{};
};

// A second transfer would wait for the chip's latency time, at least a millisecond.
TEST_F(FtdiTransport, ReadsWithOneTransfer) {
  for (const std::size_t size : {16U, 62U, 1U, 7U}) {
    std::vector<unsigned char> packet(size);
    for (std::size_t i = 0; i < size; ++i) packet[i] = static_cast<unsigned char>(i + size);
    fake.packets.push_back(packet);
    fake.transfers = 0;
    ASSERT_EQ(read(), static_cast<std::ptrdiff_t>(size));
    EXPECT_TRUE(std::equal(packet.begin(), packet.end(), bytes_.begin()));
    EXPECT_EQ(fake.transfers, 1);
  }
  fake.transfers = 0;
  EXPECT_EQ(read(), 0);
  EXPECT_EQ(fake.transfers, 1);
}

TEST_F(FtdiTransport, WhatDoesNotFitIsReadNext) {
  fake.packets.push_back({1, 2, 3, 4, 5});
  for (const int first : {1, 3, 5}) {
    EXPECT_EQ(read(2), first < 5 ? 2 : 1);
    EXPECT_EQ(bytes_[0], first);
  }
  EXPECT_EQ(fake.transfers, 1);
}

TEST_F(FtdiTransport, ATransferThatLastsTooLongIsSilenceAndOthersAreTheEnd) {
  fake.read_result = kTimedOut;
  EXPECT_EQ(read(), 0);
  fake.read_result = kGone;
  EXPECT_LT(read(), 0);
}

TEST_F(FtdiTransport, WritesAllOrSaysSo) {
  const std::array<std::uint8_t, 3> call = {0x0A, 0x43, 0x0D};
  EXPECT_TRUE(line_->write(call.data(), call.size()));
  EXPECT_TRUE(std::equal(call.begin(), call.end(), fake.sent.begin(), fake.sent.end()));
  fake.write_result = kTimedOut;
  EXPECT_FALSE(line_->write(call.data(), call.size()));
}

// The boot loader learns the coming speed from DTR.
TEST_F(FtdiTransport, SetsTheModemLinesBeforeTheSpeed) {
  EXPECT_TRUE(line_->setLine({142857, 16, false, false}));
  EXPECT_EQ(fake.asked, (std::vector<std::string>{"rts 0", "dtr 0", "baud 142857", "8N1", "flow",
                                                  "latency 16"}));
}

TEST_F(FtdiTransport, OneThatCannotBeOpenedComesWithTheRemedy) {
  const auto remedyOf = [](int result) -> std::string {
    fake.open_result = result;
    try {
      (void)openFtdi();
    } catch (const Error& error) {
      const std::string text = error.what();
      return text.substr(text.find("; ") + 2);
    }
    return "";
  };
  EXPECT_EQ(remedyOf(0), "");
  EXPECT_EQ(remedyOf(-3), "see tandem device list");
  EXPECT_EQ(remedyOf(-4), "install the udev rule of Tandem and plug it in again");
  EXPECT_EQ(remedyOf(-5), "end the other program that uses it");
  EXPECT_EQ(remedyOf(-6), "plug it in again");
}

}  // namespace
}  // namespace tandem
