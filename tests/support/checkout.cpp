#include "support/checkout.h"

namespace tandem::test {

std::string inCheckout(const std::string& path) { return TANDEM_CHECKOUT "/" + path; }

}  // namespace tandem::test
