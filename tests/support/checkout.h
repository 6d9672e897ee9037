#pragma once

#include <string>

namespace tandem::test {

/// Path of a file or folder of the checkout that this build was configured in. The build defines it
/// for one source alone, so that clones share what they compile of all other tests.
[[nodiscard]] std::string inCheckout(const std::string& path);

}  // namespace tandem::test
