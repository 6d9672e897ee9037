#include "gamepad/feel_player.h"

namespace tandem {
namespace {

constexpr double kPlayAgain = 0.4;  // less than half of an effect's second [s]

}  // namespace

FeelPlayer::~FeelPlayer() {
  stop();
  if (id_ >= 0) port_.erase(id_);
}

FeelNews FeelPlayer::show(const FeelEffect& effect, double now) noexcept {
  if (effect.level == 0) {
    stop();
    return FeelNews::kSame;
  }
  const FeelNews news = update(effect);
  const bool is_due = !is_playing_ || !(now - played_at_ < kPlayAgain);
  if (news == FeelNews::kRefused || !is_due) return news;
  is_playing_ = port_.play(id_, true);
  played_at_ = now;
  return news;
}

FeelNews FeelPlayer::update(const FeelEffect& effect) noexcept {
  const bool is_same = effect.level == shown_.level && effect.direction == shown_.direction;
  if (id_ >= 0 && is_same) return FeelNews::kSame;
  const int id = port_.upload(id_, effect);
  if (id < 0) return FeelNews::kRefused;
  id_ = id;
  shown_ = effect;
  return FeelNews::kUploaded;
}

void FeelPlayer::stop() noexcept {
  if (!is_playing_) return;
  (void)port_.play(id_, false);
  is_playing_ = false;
}

}  // namespace tandem
