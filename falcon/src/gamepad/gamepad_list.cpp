#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>

#include <unistd.h>

#include "tandem/falcon/event_port.h"

#include "gamepad/event_bits.h"

namespace tandem {
namespace {

namespace fs = std::filesystem;
using falcon_detail::parseEventBits;

/// The number of a node "event5"; empty for other names.
std::optional<int> findNumber(const std::string& name) {
  constexpr std::string_view kPrefix = "event";
  if (name.compare(0, kPrefix.size(), kPrefix) != 0) return std::nullopt;
  int number = 0;
  const char* const end = name.data() + name.size();
  const auto [rest, error] = std::from_chars(name.data() + kPrefix.size(), end, number);
  if (error != std::errc() || rest != end || number < 0) return std::nullopt;
  return number;
}

/// Numbers of the event nodes in the folder, sorted; none if it cannot be read.
std::vector<int> findNumbers(const fs::path& system) {
  std::vector<int> numbers;
  std::error_code ignored;
  for (fs::directory_iterator one(system, ignored), end; one != end; one.increment(ignored))
    if (const auto number = findNumber(one->path().filename().string())) numbers.push_back(*number);
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

/// The first line of a file, at most 1 kB; empty if it cannot be read.
std::string readLine(const fs::path& path) {
  std::ifstream file(path);
  std::array<char, 1024> line{};
  file.getline(line.data(), line.size());
  return line.data();
}

}  // namespace

std::vector<GamepadAddress> findGamepads(const std::string& system, const std::string& nodes) {
  std::vector<GamepadAddress> found;
  for (const int number : findNumbers(system)) {
    const std::string node = "event" + std::to_string(number);
    const fs::path device = fs::path(system) / node / "device";
    const fs::path codes = device / "capabilities";
    if (!falcon_detail::isGamepad(parseEventBits(readLine(codes / "abs")),
                                  parseEventBits(readLine(codes / "key"))))
      continue;
    GamepadAddress address;
    address.path = nodes + "/" + node;
    address.name = falcon_detail::toPrintable(readLine(device / "name"));
    address.feel = falcon_detail::chooseFeel(parseEventBits(readLine(codes / "ff")));
    address.may_open = ::access(address.path.c_str(), R_OK | W_OK) == 0;
    found.push_back(address);
  }
  return found;
}

}  // namespace tandem
