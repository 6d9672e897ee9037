// Uses the parts that need a library to reach a device: looks for devices. None needs to be there.
#include <cstdio>

#include "tandem/coordination/types.h"
#include "tandem/falcon/byte_transport.h"
#include "tandem/falcon/hid_port.h"

int main() try {
  tandem::HidAddress nowhere;
  nowhere.path = "/dev/null/no such node";
  std::printf("HID devices there: %zu\n", tandem::findHid(nowhere).size());
  std::printf("Falcons: %zu\n", tandem::findFtdi().size());
} catch (const tandem::Error& error) {
  std::printf("no bus to look at: %s\n", error.what());
}
