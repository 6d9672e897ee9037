/* The C door's header in C99, without another header, twice. */

#include "tandem/tandem.h"
#include "tandem/tandem.h"

typedef char states_are_packed_for_arrays[sizeof(TandemState) == 13 * sizeof(double) ? 1 : -1];
typedef char no_body_is_zero[TANDEM_NO_BODY == 0 ? 1 : -1];
