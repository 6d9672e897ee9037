#include "import/body_names.h"

#include <cctype>

namespace tandem::demos {
namespace {

constexpr std::size_t kLongest = 50;  // leaves room for a number below the 57 of a body's name

std::string clean(const std::string& wanted) {
  std::string name = wanted.empty() ? "body" : wanted.substr(0, kLongest);
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '-') c = '_';
  return name;
}

}  // namespace

std::string BodyNames::make(const std::string& wanted) {
  const std::string name = clean(wanted);
  std::string free = name;
  for (int number = 2; !taken_.insert(free).second; ++number)
    free = name + '.' + std::to_string(number);
  return free;
}

}  // namespace tandem::demos
