#include "tandem_assert.h"

#include <cstdio>
#include <cstdlib>

namespace tandem {
namespace {

void printAndAbort(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: tandem assertion failed: %s\n", file, line, condition);
  std::abort();
}

AssertHandler g_handler = printAndAbort;

}  // namespace

AssertHandler setAssertHandler(AssertHandler handler) noexcept {
  const AssertHandler before = g_handler;
  g_handler = handler;
  return before;
}

void detail::failAssert(const char* condition, const char* file, int line) noexcept {
  g_handler(condition, file, line);
}

}  // namespace tandem
