#include <algorithm>
#include <iterator>
#include <utility>

#include "tandem/falcon/simulated_device.h"

#include "simulated/force_recording.h"

namespace tandem {
namespace {

using falcon_detail::ForceRow;

class RecordedHand final : public Hand {
 public:
  explicit RecordedHand(std::vector<ForceRow> rows) : rows_(std::move(rows)) {}

  Vec3 computeForce(double t, const PointState& /*handle*/) const noexcept override {
    const auto next =
        std::upper_bound(rows_.begin(), rows_.end(), t,
                         [](double time, const ForceRow& row) { return time < row.t; });
    if (next == rows_.begin()) return rows_.front().f_W;
    if (next == rows_.end()) return rows_.back().f_W;
    const ForceRow& last = *std::prev(next);
    const double u = (t - last.t) / (next->t - last.t);
    return (1.0 - u) * last.f_W + u * next->f_W;  // this form cannot overflow between finite rows
  }

 private:
  std::vector<ForceRow> rows_;  ///< not empty, times grow
};

}  // namespace

std::unique_ptr<Hand> makeRecordedHand(const std::string& csv_path) {
  return std::make_unique<RecordedHand>(falcon_detail::readForceRecording(csv_path));
}

}  // namespace tandem
