#pragma once

#include <memory>
#include <string>

#include "tandem/tandem.h"

namespace tandem::pybullet {

struct LinkDeleter {
  void operator()(TandemLink* link) const { (void)tandem_link_destroy(link); }
};
using LinkHandle = std::unique_ptr<TandemLink, LinkDeleter>;

/// One end of the simulated link `name` of this process. Who asks first makes it, with `network`;
/// the second, with the same numbers, gets the other end; a third is refused until both ends are
/// back. Several physics clients of one process meet so. Thread: any; the sites that they serve
/// must be ticked by one thread.
class SimulatedEnd {
 public:
  SimulatedEnd(const std::string& name, const TandemNetwork& network);
  SimulatedEnd(const SimulatedEnd&) = delete;
  SimulatedEnd& operator=(const SimulatedEnd&) = delete;
  ~SimulatedEnd();

  TandemLink* link() const { return link_.get(); }

 private:
  std::string name_;
  LinkHandle link_;
};

}  // namespace tandem::pybullet
