#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include <Eigen/Core>

#include "stability/loop_events.h"
#include "stability/loop_model.h"

namespace tandem::stability {

/// Leads states through one cycle: exact maps between its events. A state at the cycle's start
/// holds devices, objects, proxies, the packets in force and those on their way, oldest first.
class Monodromy {
 public:
  explicit Monodromy(const LoopModel& model);

  /// Size of a state.
  [[nodiscard]] int size() const noexcept { return size_; }
  [[nodiscard]] double period() const noexcept { return cycle_.length; }

  /// The matrix that leads a state through a cycle.
  [[nodiscard]] Eigen::MatrixXd makeMatrix() const;

  /// The state that a constant force of 1 N on each device leads a state at rest to, in a cycle.
  [[nodiscard]] Eigen::VectorXd makePush() const;

  /// Leads one state through a cycle; gives the velocity of a site's device at each tick.
  [[nodiscard]] std::vector<std::complex<double>> watchDevice(Eigen::VectorXcd state,
                                                              int site) const;

  /// Place of the velocity of a site's device in a state.
  [[nodiscard]] int deviceVelocity(int site) const noexcept;

  /// 1 for each position of a state, 0 for each velocity: everything moved along the axis.
  [[nodiscard]] Eigen::VectorXd makeShift() const;

 private:
  template <typename Matrix>
  class Walk;

  void listKept();
  void makeMaps();
  [[nodiscard]] Eigen::MatrixXd makeMap(std::int64_t moments);

  LoopModel model_;
  LoopSystem system_;
  Cycle cycle_;
  std::vector<int> kept_;  ///< rows of the system that a state holds
  int packet_size_ = 0;
  int size_ = 0;
  std::map<std::int64_t, Eigen::MatrixXd> maps_;   ///< by the length of an interval, in moments
  std::vector<Eigen::MatrixXd> of_grid_;           ///< of multiples of the grid, from 1
  std::map<std::int64_t, Eigen::MatrixXd> rests_;  ///< of what is left beyond them
};

}  // namespace tandem::stability
