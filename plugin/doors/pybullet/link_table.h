#pragma once

#include <memory>
#include <string>

#include "tandem/tandem.h"

namespace tandem::pybullet {

struct LinkDeleter {
  void operator()(TandemLink* link) const { (void)tandem_link_destroy(link); }
};
using LinkHandle = std::unique_ptr<TandemLink, LinkDeleter>;

/// One end of the simulated link `name` of this process, so that several physics clients can meet.
/// The first caller creates the link with `network`. The second gets the other end, and must give
/// the same numbers. A third one fails until both ends are returned. Thread: any; one thread must
/// tick the connected sites.
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
