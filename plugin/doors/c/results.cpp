#include <algorithm>
#include <array>
#include <cstring>
#include <new>

#include "tandem/bullet_bridge/bullet_abi.h"
#include "tandem/coordination/types.h"

#include "c/guard.h"

namespace tandem::c_door {
namespace {

constexpr std::size_t kLongestText = 512;

/// Fixed size, so that "out of memory" can be reported, too.
thread_local std::array<char, kLongestText + 1> last_error{};

[[nodiscard]] bool continuesCharacter(char byte) noexcept {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

/// Keeps one line of complete UTF-8 characters.
void keepText(const char* text) noexcept {
  std::size_t length = std::strlen(text);
  if (length > kLongestText) {
    length = kLongestText;
    while (length > 0 && continuesCharacter(text[length])) --length;
  }
  std::copy_n(text, length, last_error.begin());
  std::replace_if(
      last_error.begin(), last_error.begin() + length,
      [](char c) { return c == '\n' || c == '\r'; }, ' ');
  last_error[length] = '\0';
}

TandemResult keep(TandemResult result, const char* text) noexcept {
  keepText(text);
  return result;
}

}  // namespace

TandemResult takeException() noexcept {
  try {
    throw;
  } catch (const Refusal& refusal) {
    return keep(refusal.result(), refusal.what());
  } catch (const WrongBulletError& error) {
    return keep(TANDEM_WRONG_BULLET, error.what());
  } catch (const std::invalid_argument& error) {
    return keep(TANDEM_INVALID_ARGUMENT, error.what());
  } catch (const Error& error) {
    return keep(TANDEM_CANNOT, error.what());
  } catch (const std::bad_alloc&) {
    return keep(TANDEM_NO_MEMORY, "out of memory; nothing was changed");
  } catch (const std::length_error&) {
    return keep(TANDEM_NO_MEMORY, "more than memory can hold; nothing was changed");
  } catch (const std::exception& error) {
    return keep(TANDEM_INTERNAL, error.what());
  } catch (...) {
    return keep(TANDEM_INTERNAL, "an exception that says nothing");
  }
}

}  // namespace tandem::c_door

extern "C" {

const char* tandem_result_name(TandemResult result) {
  // Indexed by number: another language may pass a value outside the enumeration.
  constexpr std::array<const char*, 8> kNames{
      "TANDEM_OK",     "TANDEM_INVALID_ARGUMENT", "TANDEM_CANNOT",    "TANDEM_WRONG_BULLET",
      "TANDEM_IN_USE", "TANDEM_WORLD_GONE",       "TANDEM_NO_MEMORY", "TANDEM_INTERNAL"};
  const auto number = static_cast<unsigned>(result);
  return number < kNames.size() ? kNames[number] : "no TandemResult";
}

const char* tandem_last_error(void) { return tandem::c_door::last_error.data(); }

const char* tandem_version(void) { return TANDEM_VERSION; }

size_t tandem_scalar_bytes(void) { return tandem::bulletAbiOfThisCode().scalar_bytes; }

}  // extern "C"
