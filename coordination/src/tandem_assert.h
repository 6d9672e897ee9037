#pragma once

/// \file
/// TANDEM_ASSERT(condition) catches a bug in the caller or in Tandem, not bad input. It is
/// active in builds without NDEBUG. On failure it calls the handler, which by default prints one
/// line and aborts.
#pragma GCC visibility push(default)
namespace tandem {

using AssertHandler = void (*)(const char* condition, const char* file, int line);

/// Replaces the handler and returns the previous one. Not thread safe: call before the first tick.
AssertHandler setAssertHandler(AssertHandler handler) noexcept;

namespace detail {
void failAssert(const char* condition, const char* file, int line) noexcept;
}

}  // namespace tandem
#pragma GCC visibility pop

#ifdef NDEBUG
#define TANDEM_ASSERT(condition) static_cast<void>(sizeof(!(condition)))
#else
#define TANDEM_ASSERT(condition)      \
  ((condition) ? static_cast<void>(0) \
               : ::tandem::detail::failAssert(#condition, __FILE__, __LINE__))
#endif
