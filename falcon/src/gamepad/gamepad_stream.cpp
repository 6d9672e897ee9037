#include "gamepad/gamepad_stream.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tandem/coordination/types.h"
#include "tandem/falcon/monotonic_clock.h"

#include "guard/settings_check.h"

namespace tandem {
namespace {

constexpr double kPeriod = 0.01;         // between two updates of the effect [s]
constexpr double kLongestSilence = 0.1;  // a force without a newer one ends then [s]

GamepadSettings checked(const GamepadSettings& settings) {
  using falcon_detail::require;
  require(std::isfinite(settings.first_retry) && settings.first_retry > 0.0,
          "first_retry of the gamepad", settings.first_retry, "finite and above 0 [s]");
  require(std::isfinite(settings.longest_retry) && settings.longest_retry >= settings.first_retry,
          "longest_retry of the gamepad", settings.longest_retry,
          "finite, at least first_retry [s]");
  return settings;
}

}  // namespace

GamepadStream::GamepadStream(EventOpener open, const GamepadSettings& settings)
    : open_(std::move(open)),
      settings_(checked(settings)),
      thread_("gamepad", settings_.first_retry, settings_.longest_retry) {
  connect();
  thread_.start({[this] { exchangeUntilGone(); }, [this] { disconnect(); }, [this] { connect(); }});
}

void GamepadStream::setForce(const Vec3& f_D) noexcept {
  order_.write({{f_D.x(), f_D.y(), f_D.z()}, readMonotonicClock()});
}

GamepadCounters GamepadStream::counters() const noexcept {
  return {reports_, dropped_, uploads_, refused_, thread_.losses()};
}

void GamepadStream::connect() {
  line_ = std::make_unique<GamepadLine>(open_());
  thread_.setName(line_->name());
  publish();
}

/// Tells the loss first: a device that hangs may take its time to stop.
void GamepadStream::disconnect() noexcept {
  thread_.setTrouble(name() + " is gone; plug it in again");
  const std::unique_ptr<GamepadLine> gone = std::move(line_);
  publish();
}

/// A device that sends without end does not keep the force from being rendered.
void GamepadStream::exchangeUntilGone() noexcept {
  double next = readMonotonicClock();
  while (!thread_.isEnding()) {
    const double now = readMonotonicClock();
    if (now >= next) {
      render(now);
      next = now + kPeriod;
    }
    if (!listen(std::max(next - readMonotonicClock(), 0.0))) return;
  }
}

bool GamepadStream::listen(double wait) noexcept {
  const GamepadLine::Heard heard = line_->listen(wait);
  if (heard.is_gone) return false;
  publish();
  dropped_ += heard.dropped;
  reports_ += heard.reports;  // last: a thread that sees the count also sees the report's effect
  return true;
}

void GamepadStream::render(double now) noexcept {
  const Order& order = order_.read();
  const bool is_fresh = now - order.time < kLongestSilence;
  const Vec3 f_D = is_fresh ? Vec3(order.f_D[0], order.f_D[1], order.f_D[2]) : Vec3(Vec3::Zero());
  const FeelNews news = line_->render(f_D, settings_.max_force, now);
  if (news != FeelNews::kSame) ++uploads_;
  if (news == FeelNews::kRefused) ++refused_;
}

void GamepadStream::publish() noexcept {
  News news;
  news.is_connected = line_ != nullptr;
  if (line_) news.state = line_->state();
  if (line_) news.feel = line_->feel();
  news.time = readMonotonicClock();
  news_.write(news);
}

}  // namespace tandem
