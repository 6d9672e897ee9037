// A written key file reads back. All others are refused by one line with the remedy.

#include "tandem/plugin/key_file.h"

#include <algorithm>
#include <cctype>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tandem/coordination/types.h"

#include "secure/key_text.h"
#include "secure/secure_support.h"

namespace tandem::test {
namespace {

namespace fs = std::filesystem;
using secure::KeyTextFault;

const std::string kHeader = "tandem-key-1 for a test\n";
const std::string kDigits = "000102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f";

KeyTextFault faultOf(const std::string& text) {
  ByteVector key(SecretKey::kSize, 0xaa);
  const KeyTextFault fault = secure::readKeyText(text, key);
  if (fault != KeyTextFault::kNone) {
    EXPECT_EQ(key, ByteVector(SecretKey::kSize, 0)) << "not wiped: " << text;
  }
  return fault;
}

TEST(KeyText, ReadsBack) {
  constexpr std::uint64_t kSeed = 23;
  Draw draw(kSeed);
  for (int trial = 0; trial < 1000; ++trial) {
    const ByteVector key = draw.bytes(SecretKey::kSize);
    std::array<char, secure::kKeyTextSize> text{};
    secure::writeKeyText(key, text);
    ByteVector again(SecretKey::kSize);
    ASSERT_EQ(secure::readKeyText({text.data(), text.size()}, again), KeyTextFault::kNone);
    ASSERT_EQ(again, key) << "seed " << kSeed << ", trial " << trial;
  }
}

TEST(KeyText, DigitsOfBothCases) {
  std::string upper = kDigits;
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  ByteVector key(SecretKey::kSize), again(SecretKey::kSize);
  EXPECT_EQ(secure::readKeyText(kHeader + kDigits + "\n", key), KeyTextFault::kNone);
  EXPECT_EQ(secure::readKeyText(kHeader + upper + "\n", again), KeyTextFault::kNone);
  EXPECT_EQ(toHex(key), kDigits);
  EXPECT_EQ(again, key);
}

TEST(KeyText, RefusesEveryCharacterThatIsNoDigit) {
  for (int value = 0; value < 256; ++value) {
    const char c = static_cast<char>(value);
    std::string digits = kDigits;
    digits[20] = c;
    const bool is_digit = std::string("0123456789abcdefABCDEF").find(c) != std::string::npos;
    const KeyTextFault expected = is_digit    ? KeyTextFault::kNone
                                  : c == '\n' ? KeyTextFault::kTooShort
                                              : KeyTextFault::kDigits;
    EXPECT_EQ(faultOf(kHeader + digits + "\n"), expected) << value;
  }
}

TEST(KeyText, RefusesOtherHeaders) {
  const std::string rest = kDigits + "\n";
  EXPECT_EQ(faultOf("tandem-key-1\n" + rest), KeyTextFault::kNone);
  for (const char* header : {"", "\n", "tandem-key-1", "tandem-key-2 \n", "tandem-key-10 \n",
                             " tandem-key-1 \n", "Tandem-key-1 \n", "tandem-key-1\r\n"})
    EXPECT_EQ(faultOf(header + rest), KeyTextFault::kHeader) << header;
  const std::string longest = "tandem-key-1 " + std::string(secure::kLongestKeyHeader - 14, 'x');
  EXPECT_EQ(faultOf(longest + "\n" + rest), KeyTextFault::kNone);
  EXPECT_EQ(faultOf(longest + "x\n" + rest), KeyTextFault::kHeader);
}

TEST(KeyText, RefusesOtherLengths) {
  for (std::size_t size = 0; size < kDigits.size(); ++size) {
    EXPECT_EQ(faultOf(kHeader + kDigits.substr(0, size)), KeyTextFault::kTooShort) << size;
    EXPECT_EQ(faultOf(kHeader + kDigits.substr(0, size) + "\n"), KeyTextFault::kTooShort) << size;
  }
  EXPECT_EQ(faultOf(kHeader + kDigits), KeyTextFault::kTooShort);
  for (const char* more : {"0\n", " \n", "\r\n", "\n\n", "\nmore\n", "\n ", "00"})
    EXPECT_EQ(faultOf(kHeader + kDigits + more), KeyTextFault::kTrailing) << more;
}

class KeyFile : public ::testing::Test {
 protected:
  KeyFile() {
    std::string name = (fs::temp_directory_path() / "tandem_key_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a folder");
    folder = name;
  }
  ~KeyFile() override { fs::remove_all(folder); }

  /// Writes a file with this text that only its owner may read.
  [[nodiscard]] fs::path write(const std::string& text, mode_t mode = 0600) const {
    const fs::path path = folder / "written.key";
    std::ofstream(path) << text;
    EXPECT_EQ(chmod(path.c_str(), mode), 0);
    return path;
  }

  [[nodiscard]] static std::string contentOf(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// Expects an error of one line with the path and these words.
  static void expectRefused(const std::function<void()>& act,
                            const std::vector<std::string>& words) {
    try {
      act();
      ADD_FAILURE() << "was not refused";
    } catch (const std::invalid_argument& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      for (const std::string& word : words)
        EXPECT_NE(message.find(word), std::string::npos) << '"' << word << "\" in: " << message;
    }
  }
  static void expectReadRefused(const fs::path& path, std::vector<std::string> words) {
    words.push_back(path.string());
    expectRefused([&] { (void)readKeyFile(path); }, words);
  }

  fs::path folder;
};

TEST_F(KeyFile, ReadsWhatWasMade) {
  makeKeyFile(folder / "a.key");
  makeKeyFile(folder / "b.key");
  const SecretKey a = readKeyFile(folder / "a.key"), again = readKeyFile(folder / "a.key");
  EXPECT_TRUE(a.equals(again));
  EXPECT_FALSE(a.equals(readKeyFile(folder / "b.key")));

  const std::string text = contentOf(folder / "a.key");
  EXPECT_TRUE(text.starts_with("tandem-key-1 "));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2);
  EXPECT_NE(text.find('\n' + toHex(a) + '\n'), std::string::npos);
}

TEST_F(KeyFile, IsItsOwnersWhateverTheUmask) {
  for (const mode_t mask : {mode_t{0}, mode_t{022}, mode_t{0777}}) {
    const mode_t before = umask(mask);
    const fs::path path = folder / std::to_string(mask);
    makeKeyFile(path);
    umask(before);
    struct stat status {};
    ASSERT_EQ(stat(path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777U, 0600U);
    (void)readKeyFile(path);
  }
}

TEST_F(KeyFile, NeverOverwrites) {
  const fs::path path = write("precious");
  expectRefused([&] { makeKeyFile(path); }, {path.string(), "never overwritten", "another name"});
  EXPECT_EQ(contentOf(path), "precious");

  fs::create_symlink(path, folder / "link");
  fs::create_symlink(folder / "nowhere", folder / "dangling");
  for (const char* name : {"link", "dangling", "."}) {
    const fs::path taken = folder / name;
    expectRefused([&] { makeKeyFile(taken); }, {taken.string()});
  }
  EXPECT_EQ(contentOf(path), "precious");
  EXPECT_FALSE(fs::exists(folder / "nowhere"));
}

TEST_F(KeyFile, RefusesAFolderThatIsNotThere) {
  const fs::path path = folder / "missing" / "a.key";
  expectRefused([&] { makeKeyFile(path); }, {path.string(), "No such file", "folder"});
}

/// Returns 0 if a key that does not fit is an error of one line and leaves no file. Runs in its own
/// process: its files stay small.
int makeKeyWithoutRoom(const fs::path& path) {
  constexpr rlim_t kRoom = 40;  // smaller than a key file [bytes]
  const rlimit limit{kRoom, kRoom};
  signal(SIGXFSZ, SIG_IGN);
  if (setrlimit(RLIMIT_FSIZE, &limit) != 0) return 2;
  try {
    makeKeyFile(path);
  } catch (const Error& error) {
    const std::string message = error.what();
    return message.starts_with(path.string() + ": cannot be written: ") && !fs::exists(path) ? 0
                                                                                             : 3;
  }
  return 1;
}

TEST_F(KeyFile, LeavesNothingHalfWritten) {
  EXPECT_EXIT(std::exit(makeKeyWithoutRoom(folder / "a.key")), ::testing::ExitedWithCode(0), "");
}

TEST_F(KeyFile, RefusesRightsOfGroupAndOthers) {
  const std::string text = kHeader + kDigits + "\n";
  for (const mode_t mode : {0640, 0604, 0620, 0602, 0610, 0601, 0644, 0666, 0777}) {
    const fs::path path = write(text, mode);
    expectReadRefused(path, {"others have rights", "chmod 600 " + path.string()});
  }
  for (const mode_t mode : {0600, 0400, 0700}) {
    SCOPED_TRACE(mode);
    EXPECT_EQ(toHex(readKeyFile(write(text, mode))), kDigits);
    fs::remove(folder / "written.key");
  }
}

TEST_F(KeyFile, FollowsLinksToTheRightsOfTheFile) {
  const fs::path path = write(kHeader + kDigits + "\n"), link = folder / "link";
  fs::create_symlink(path, link);
  EXPECT_EQ(toHex(readKeyFile(link)), kDigits);
  ASSERT_EQ(chmod(path.c_str(), 0644), 0);
  expectReadRefused(link, {"chmod 600"});
}

TEST_F(KeyFile, RefusesWhatIsNoRegularFile) {
  ASSERT_EQ(chmod(folder.c_str(), 0700), 0);
  expectReadRefused(folder, {"no regular file"});
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  expectReadRefused(pipe, {"no regular file"});
  expectReadRefused("/dev/zero", {"no regular file"});
}

TEST_F(KeyFile, RefusesWhatIsNotThere) {
  expectReadRefused(folder / "missing.key", {"No such file", "tandem key new"});
}

TEST_F(KeyFile, RefusesOtherTexts) {
  expectReadRefused(write(""), {"line 1", "tandem-key-1"});
  expectReadRefused(write("[network]\ndelay = 0.1\n"), {"line 1", "tandem-key-1"});
  expectReadRefused(write(kHeader + kDigits.substr(1) + "\n"), {"too short", "64 hexadecimal"});
  expectReadRefused(write(kHeader + kDigits + "0\n"), {"follows", "64 hexadecimal"});
  expectReadRefused(write(kHeader + kDigits + "\n\n"), {"follows"});
  expectReadRefused(write(kHeader + std::string(64, 'g') + "\n"), {"64 hexadecimal"});
  const std::string header = "tandem-key-1 " + std::string(secure::kLongestKeyHeader - 14, 'x');
  expectReadRefused(write(header + "\n" + kDigits + "\n" + std::string(100000, '0')), {"follows"});
  EXPECT_EQ(toHex(readKeyFile(write(header + "\n" + kDigits + "\n"))), kDigits);
}

TEST_F(KeyFile, MessagesQuoteNoKey) {
  const fs::path path = write(kHeader + kDigits + "0\n");
  try {
    (void)readKeyFile(path);
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()).find(kDigits.substr(0, 6)), std::string::npos);
  }
}

TEST_F(KeyFile, NamesWithLineBreaksStayOnOneLine) {
  expectRefused([&] { (void)readKeyFile(folder / "a\nb"); }, {"a?b"});
}

}  // namespace
}  // namespace tandem::test
