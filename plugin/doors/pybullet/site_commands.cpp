#include <cmath>
#include <cstring>

#include "c/site_words.h"
#include "commands.h"
#include "refusal.h"

namespace tandem::pybullet {
namespace {

void readGains(Words& words, const char* key, TandemGains& gains) {
  double values[2]{};
  if (words.numbersIfThere(key, values, 2)) gains = {values[0], values[1]};
}

/// Sets a number if its word is there.
void readNumber(Words& words, const c_door::SiteWord& number, TandemSiteSettings& settings) {
  const bool is_gain = std::strchr(number.word, '.') != nullptr;  // two of them are one word
  if (is_gain || !words.has(number.word)) return;
  double value = 0.0;
  if (number.is_flag) {
    value = words.flag(number.word, false) ? 1.0 : 0.0;
  } else {
    value = number.is_integer ? words.integer(number.word) : words.number(number.word);
  }
  number.set(settings, value);
}

TandemCoordinationMode readCoordinationMode(Words& words) {
  const std::string mode = words.text("coordination_mode", "sum");
  if (mode == "sum") return TANDEM_COORDINATION_SUM;
  if (mode == "average") return TANDEM_COORDINATION_AVERAGE;
  throw Refusal(kBadCommand, "coordination_mode=" + mode + ": there are sum and average");
}

}  // namespace

void Commands::device(Words& words, Reply&) {
  const std::string kind = words.text("kind");
  double start[3]{};
  words.numbersIfThere("start", start, 3);
  TandemDevice* device = nullptr;
  if (kind == "moved") {
    TandemDeviceLimits limits{};
    limits.max_force = words.number("max_force", HUGE_VAL);
    limits.max_slew = words.number("max_slew", HUGE_VAL);
    words.finish();
    check(tandem_device_create_moved(start, limits, &device));
  } else if (kind == "simulated") {
    const double mass = words.number("mass", 0.1);
    const double damping = words.number("damping", 0.5);
    double guide[3]{};
    const bool has_guide = words.numbersIfThere("guide", guide, 3);
    words.finish();
    check(
        tandem_device_create_simulated(mass, damping, start, has_guide ? guide : nullptr, &device));
  } else {
    throw Refusal(kBadCommand, "kind=" + kind + ": there are moved and simulated");
  }
  session_.takeDevice(DeviceHandle(device), kind == "moved");
}

void Commands::site(Words& words, Reply&) {
  TandemSiteSettings settings = tandem_default_site_settings();
  const int self = words.integer("self", 1);
  if (self < 1) throw Refusal(kBadCommand, "self: 1 or more");
  settings.self = static_cast<std::uint32_t>(self);
  for (const c_door::SiteWord& word : c_door::kSiteWords) readNumber(words, word, settings);
  readGains(words, "contact", settings.contact);
  readGains(words, "coordination", settings.coordination);
  const std::string scheme = words.text("scheme", settings.scheme);
  settings.scheme = scheme.c_str();
  settings.coordination_mode = readCoordinationMode(words);
  settings.has_guide = words.numbersIfThere("guide", settings.guide, 3) ? 1 : 0;
  words.finish();
  session_.openSite(settings);
}

}  // namespace tandem::pybullet
