// Includes the C door's header in C++17 twice, without another header.

#include "tandem/tandem.h"

static_assert(__cplusplus == 201703L, "this is a check for C++17");
static_assert(sizeof(TandemState) == 13 * sizeof(double), "states are packed for arrays");
static_assert(TANDEM_NO_BODY == TandemBody{0}, "");
