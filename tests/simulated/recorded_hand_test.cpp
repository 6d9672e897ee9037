#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tandem/falcon/simulated_device.h"

namespace tandem {
namespace {

const std::string kHeader = "t,force_x,force_y,force_z\n";

/// Each test has a file of its own and removes it. Tests may run in parallel processes.
class RecordedHandTest : public ::testing::Test {
 protected:
  RecordedHandTest()
      : path_(::testing::TempDir() + "tandem_recorded_hand_" + std::to_string(::getpid()) +
              ".csv") {}
  ~RecordedHandTest() override { std::filesystem::remove(path_); }

  std::unique_ptr<Hand> load(const std::string& content) const {
    std::ofstream(path_, std::ios::binary) << content;
    return makeRecordedHand(path_);
  }

  /// The message that refuses `content`, after the file's name; one line.
  std::string refusal(const std::string& content) const {
    try {
      (void)load(content);
    } catch (const Error& error) {
      const std::string text = error.what();
      EXPECT_EQ(text.find_first_of("\r\n\t"), std::string::npos) << text;
      EXPECT_NE(text.find("; "), std::string::npos) << "no remedy in: " << text;
      EXPECT_EQ(text.substr(0, path_.size()), path_);
      return text.substr(path_.size());
    }
    return "accepted";
  }

  const std::string path_;
};

TEST_F(RecordedHandTest, IsLinearBetweenRowsAndHeldOutside) {
  const auto hand = load(kHeader + "0.5,1,-2,0\n1,3,2,0.5\n3,-1,0,1e-1\n");
  EXPECT_EQ(hand->computeForce(-1.0, {}), Vec3(1, -2, 0));
  EXPECT_EQ(hand->computeForce(0.5, {}), Vec3(1, -2, 0));
  EXPECT_EQ(hand->computeForce(0.75, {}), Vec3(2, 0, 0.25));
  EXPECT_EQ(hand->computeForce(1.0, {}), Vec3(3, 2, 0.5));
  EXPECT_LT((hand->computeForce(2.0, {}) - Vec3(1, 1, 0.3)).norm(), 1e-15);
  EXPECT_EQ(hand->computeForce(3.0, {}), Vec3(-1, 0, 0.1));
  EXPECT_EQ(hand->computeForce(1e9, {}), Vec3(-1, 0, 0.1));
}

TEST_F(RecordedHandTest, FindsTheRightRowInALongRecording) {
  constexpr int kRows = 1000;
  std::string content = kHeader;
  for (int i = 0; i < kRows; ++i) {
    content += std::to_string(i) + "," + std::to_string(i * i) + ",0,0\n";
  }
  const auto hand = load(content);
  for (int i = 0; i + 1 < kRows; ++i) {
    // All numbers are small integers and halves, so results are exact.
    EXPECT_EQ(hand->computeForce(i, {}).x(), i * i);
    EXPECT_EQ(hand->computeForce(i + 0.5, {}).x(), 0.5 * (i * i + (i + 1) * (i + 1)));
  }
}

TEST_F(RecordedHandTest, TakesOneRowCrlfAndAMissingLastLineEnd) {
  EXPECT_EQ(load(kHeader + "0,1,2,3")->computeForce(5.0, {}), Vec3(1, 2, 3));
  const auto hand = load("t,force_x,force_y,force_z\r\n0,1,2,3\r\n1,3,4,5\r\n");
  EXPECT_EQ(hand->computeForce(0.5, {}), Vec3(2, 3, 4));
}

TEST_F(RecordedHandTest, StaysFiniteBetweenTheLargestForces) {
  const auto hand = load(kHeader + "0,1e6,0,0\n1,-1e6,0,0\n");
  for (int i = 0; i <= 10; ++i) EXPECT_TRUE(hand->computeForce(0.1 * i, {}).allFinite()) << i;
}

TEST_F(RecordedHandTest, RefusesAWrongHeader) {
  for (const std::string header :
       {"t,force_x,force_y\n", "t;force_x;force_y;force_z\n", "0,1,2,3\n", "\n",
        "T,force_x,force_y,force_z\n", "t,force_x,force_y,force_z,torque\n",
        " t,force_x,force_y,force_z\n"}) {
    const std::string text = refusal(header + "0,1,2,3\n");
    EXPECT_EQ(text.rfind(":1: header is ", 0), 0U) << text;
    EXPECT_NE(text.find("must be t,force_x,force_y,force_z"), std::string::npos) << text;
  }
}

TEST_F(RecordedHandTest, RefusesFilesWithoutRows) {
  EXPECT_EQ(refusal("").rfind(":1: the file is empty; ", 0), 0U);
  EXPECT_EQ(refusal(kHeader).rfind(":2: no rows after the header; ", 0), 0U);
  EXPECT_EQ(refusal(kHeader + "0,1,2,3\n\n1,1,2,3\n").rfind(":3: line is empty; ", 0), 0U);
}

struct BadRow {
  std::string row;
  std::string complaint;
};

TEST_F(RecordedHandTest, RefusesBadRowsWithLineColumnAndText) {
  const BadRow bad_rows[] = {
      {"1,2,abc,3", "force_y is 'abc', not a number"},
      {"1,2,3,", "force_z is '', not a number"},
      {"1, 2,3,4", "force_x is ' 2', not a number"},
      {"1,+2,3,4", "force_x is '+2', not a number"},
      {"1,2,3,4N", "force_z is '4N', not a number"},
      {"1,2,0x10,4", "force_y is '0x10', not a number"},
      {"1;2;3;4", "t is '1;2;3;4', not a number"},
      {"\x01\t,2,3,4", "t is '?\?', not a number"},
      {std::string(99, 'x') + ",2,3,4", "t is '" + std::string(40, 'x') + "...', not a number"},
      {"nan,2,3,4", "t is 'nan', not finite"},
      {"1,inf,3,4", "force_x is 'inf', not finite"},
      {"1,2,-inf,4", "force_y is '-inf', not finite"},
      {"1,2,3,1e999", "force_z is '1e999', out of range"},
      {"1,1e300,3,4", "force_x is '1e300', above 1e6 N"},
      {"1,2,-1000000.5,4", "force_y is '-1000000.5', above 1e6 N"},
      {"1,2,3", "row has 3 columns"},
      {"1", "row has 1 columns"},
      {"1,2,3,4,5", "row has 5 columns"},
      {"0,2,3,4", "t is 0 after 0"},
      {"-0.5,2,3,4", "t is -0.5 after 0"},
  };
  for (const BadRow& bad : bad_rows) {
    const std::string text = refusal(kHeader + "0,1,1,1\n" + bad.row + "\n2,1,1,1\n");
    EXPECT_EQ(text.rfind(":3: " + bad.complaint + "; ", 0), 0U) << bad.complaint << " in: " << text;
  }
}

TEST_F(RecordedHandTest, RefusesADeviceAndAPipeWithoutReadingThem) {
  const std::string pipe = path_ + ".pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& path : {pipe, std::string("/dev/zero")}) {
    try {
      (void)makeRecordedHand(path);
      ADD_FAILURE() << "accepted " << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.what(), path + ": is a device or a pipe; give the path of a CSV file");
    }
  }
  std::remove(pipe.c_str());
}

TEST_F(RecordedHandTest, RefusesAFileThatCannotBeRead) {
  for (const std::string& path : {path_ + ".missing", ::testing::TempDir(), std::string()}) {
    try {
      (void)makeRecordedHand(path);
      ADD_FAILURE() << "accepted " << path;
    } catch (const Error& error) {
      const std::string text = error.what();
      EXPECT_EQ(text.rfind(path + ": cannot be read (", 0), 0U) << text;
      EXPECT_NE(text.find("; give the path"), std::string::npos) << text;
    }
  }
}

}  // namespace
}  // namespace tandem
