#include "peer/publishing.h"

#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include "peer/dds/dds_domain.h"

namespace tandem::demos {
namespace {

constexpr double kPeriod = 1.0 / 60.0;  // of pictures [s]
constexpr double kSameTime = 1e-6;      // times of host steps are rounded [s]

}  // namespace

PublishStates makePublisher(const std::string& word, const std::string& what) {
  const int domain = readDdsDomain("--publish", word);
  PublishStates publish = makeDdsPublisher(domain);
  fmt::print(stderr,
             "tandem: note: --publish shows {}, in clear, to everybody on DDS domain {} of this "
             "network\n",
             what, domain);
  return publish;
}

SitePublisher::SitePublisher(PublishStates publish, PeerId site)
    : publish_(std::move(publish)), thread_([this](const std::stop_token& stop) { run(stop); }) {
  latest_.site = site;
}

void SitePublisher::noteStep(double time, Site& site) {
  const bool is_of_next_run = time < next_ - kPeriod;  // which begins at 0 again
  if (time < next_ - kSameTime && !is_of_next_run) return;
  next_ = time + kPeriod;
  latest_.time = time;
  read(site);
  {
    const std::lock_guard lock(mutex_);
    newest_ = latest_;
    has_newest_ = true;
  }
  is_new_.notify_one();
}

/// The vector grows before the haptic thread copies into it.
void SitePublisher::read(Site& site) {
  const int count = site.objectCount();
  latest_.objects.reserve(static_cast<std::size_t>(count));
  site.betweenTicks([&] {
    latest_.tick = site.tickCount();
    latest_.hand = site.hip().point();
    latest_.force_W = site.force();
    latest_.objects.clear();
    for (ObjectId id = 0; static_cast<int>(id) < count; ++id)
      if (site.isShared(id)) latest_.objects.push_back({id, site.object(id)});
  });
}

void SitePublisher::run(const std::stop_token& stop) {
  SiteStates states;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      if (!is_new_.wait(lock, stop, [this] { return has_newest_; })) return;
      states = newest_;
      has_newest_ = false;
    }
    publish_(states);
  }
}

}  // namespace tandem::demos
