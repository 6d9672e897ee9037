#include "stability/monodromy.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <unsupported/Eigen/MatrixFunctions>

namespace tandem::stability {
namespace {

std::int64_t toMoments(double duration) { return std::llround(duration / kOneMoment); }

}  // namespace

/// Values of the system and packets on their way, as functions of the state at the cycle's start:
/// rows for values, one column for each number of the state, or one column for one state.
template <typename Matrix>
class Monodromy::Walk {
 public:
  Walk(const Monodromy& of, const Matrix& start)
      : of_(of), values_(Matrix::Zero(of.system_.size(), start.cols())) {
    int row = 0;
    for (const int place : of.kept_) values_.row(place) = start.row(row++);
    for (const int count : of.cycle_.in_flight) {
      auto& queue = queues_.emplace_back();
      for (int i = 0; i < count; ++i, row += of.packet_size_)
        queue.push_back(start.middleRows(row, of.packet_size_));
    }
  }

  void push() { values_.row(of_.system_.push()).setOnes(); }

  template <typename Visit>
  void run(Visit atTick) {
    double now = 0.0;
    for (const Event& event : of_.cycle_.events) {
      advance(event.time - now);
      now = event.time;
      switch (event.kind) {
        case EventKind::kArrival:
          arrive(event.channel);
          break;
        case EventKind::kTick:
          for (int i = 0; i < of_.model_.sites; ++i) tick(i);
          atTick(values_);
          break;
        case EventKind::kSend:
          send(event.channel);
          break;
      }
    }
    advance(of_.cycle_.length - now);
  }

  [[nodiscard]] Matrix finish() const {
    Matrix end(of_.size_, values_.cols());
    int row = 0;
    for (const int place : of_.kept_) end.row(row++) = values_.row(place);
    for (const auto& queue : queues_)
      for (const Matrix& packet : queue) {
        end.middleRows(row, of_.packet_size_) = packet;
        row += of_.packet_size_;
      }
    return end;
  }

 private:
  void advance(double duration) {
    const std::int64_t moments = toMoments(duration);
    if (moments == 0) return;
    next_.noalias() = of_.maps_.at(moments) * values_;
    values_.swap(next_);
  }
  void tick(int i) {
    const SitePlaces& at = of_.system_.site(i);
    values_.middleRows(at.hip, 2) = values_.middleRows(at.device, 2).eval();
    values_.row(at.force) = (of_.system_.force(i) * values_).eval();
  }
  void send(int c) {
    const Channel& channel = of_.model_.channels[static_cast<std::size_t>(c)];
    const SitePlaces& from = of_.system_.site(channel.source);
    const ChannelPlaces& to = of_.system_.channel(c);
    Matrix packet(of_.packet_size_, values_.cols());
    int row = 0;
    if (to.device >= 0) packet.middleRows(row, 2) = values_.middleRows(from.device, 2);
    if (to.device >= 0) row += 2;
    if (to.object >= 0) packet.middleRows(row, 2) = values_.middleRows(from.object, 2);
    queues_[static_cast<std::size_t>(c)].push_back(std::move(packet));
  }
  void arrive(int c) {
    auto& queue = queues_[static_cast<std::size_t>(c)];
    const ChannelPlaces& to = of_.system_.channel(c);
    int row = 0;
    if (to.device >= 0) values_.middleRows(to.device, 2) = queue.front().middleRows(row, 2);
    if (to.device >= 0) row += 2;
    if (to.object >= 0) values_.middleRows(to.object, 2) = queue.front().middleRows(row, 2);
    queue.pop_front();
  }

  const Monodromy& of_;
  Matrix values_, next_;
  std::vector<std::deque<Matrix>> queues_;
};

Monodromy::Monodromy(const LoopModel& model)
    : model_(model), system_(model), cycle_(makeCycle(model)) {
  listKept();
  makeMaps();
}

/// The tick at the start sets hip and force anew.
void Monodromy::listKept() {
  const auto keep = [&](int place) {
    if (place < 0) return 0;
    kept_.push_back(place);
    kept_.push_back(place + 1);
    return 2;
  };
  for (int i = 0; i < model_.sites; ++i) {
    keep(system_.site(i).device);
    keep(system_.site(i).object);
    keep(system_.site(i).proxy);
  }
  for (std::size_t c = 0; c < model_.channels.size(); ++c) {
    const ChannelPlaces& at = system_.channel(static_cast<int>(c));
    packet_size_ = keep(at.device);
    packet_size_ += keep(at.object);
  }
  size_ = static_cast<int>(kept_.size());
  for (const int count : cycle_.in_flight) size_ += count * packet_size_;
}

void Monodromy::makeMaps() {
  double now = 0.0;
  const auto add = [&](double until) {
    const std::int64_t moments = toMoments(until - now);
    if (moments != 0 && !maps_.count(moments)) maps_.emplace(moments, makeMap(moments));
    now = until;
  };
  for (const Event& event : cycle_.events) add(event.time);
  add(cycle_.length);
}

/// Nearly all intervals are multiples of the grid, but for what the delay adds: a product costs a
/// tenth of an exponential.
Eigen::MatrixXd Monodromy::makeMap(std::int64_t moments) {
  const double grid = cycle_.grid / kOneMoment;
  const auto count = static_cast<std::size_t>((static_cast<double>(moments) + 0.5) / grid);
  const auto rest = std::llround(static_cast<double>(moments) - static_cast<double>(count) * grid);
  while (of_grid_.size() < count)
    of_grid_.push_back(of_grid_.empty() ? Eigen::MatrixXd((cycle_.grid * system_.rates()).exp())
                                        : Eigen::MatrixXd(of_grid_.front() * of_grid_.back()));
  if (rest <= 0) return of_grid_[count - 1];
  auto of_rest = rests_.find(rest);
  if (of_rest == rests_.end()) {
    const Eigen::MatrixXd exponent = static_cast<double>(rest) * kOneMoment * system_.rates();
    of_rest = rests_.emplace(rest, exponent.exp()).first;
  }
  if (count == 0) return of_rest->second;
  return of_rest->second * of_grid_[count - 1];
}

Eigen::MatrixXd Monodromy::makeMatrix() const {
  Walk<Eigen::MatrixXd> walk(*this, Eigen::MatrixXd::Identity(size_, size_));
  walk.run([](const Eigen::MatrixXd&) {});
  return walk.finish();
}

Eigen::VectorXd Monodromy::makePush() const {
  Walk<Eigen::MatrixXd> walk(*this, Eigen::MatrixXd::Zero(size_, 1));
  walk.push();
  walk.run([](const Eigen::MatrixXd&) {});
  return walk.finish();
}

std::vector<std::complex<double>> Monodromy::watchDevice(Eigen::VectorXcd state, int site) const {
  std::vector<std::complex<double>> velocities;
  Walk<Eigen::MatrixXcd> walk(*this, Eigen::MatrixXcd(state));
  const int place = system_.site(site).device + 1;
  walk.run([&](const Eigen::MatrixXcd& values) { velocities.push_back(values(place, 0)); });
  return velocities;
}

int Monodromy::deviceVelocity(int site) const noexcept {
  const auto at = std::find(kept_.begin(), kept_.end(), system_.site(site).device + 1);
  return static_cast<int>(at - kept_.begin());
}

Eigen::VectorXd Monodromy::makeShift() const {
  Eigen::VectorXd shift(size_);
  for (int i = 0; i < size_; ++i) shift(i) = i % 2 == 0 ? 1.0 : 0.0;
  return shift;
}

}  // namespace tandem::stability
