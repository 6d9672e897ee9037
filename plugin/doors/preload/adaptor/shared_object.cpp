#include "shared_object.h"

#include <cstdio>
#include <exception>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/convert.h"

#include "preload/interposer/say.h"

namespace tandem::preload {
namespace {

/// Values that must be equal at both sites.
Configuration makeAgreement(const PreloadConfig& config, const ObjectChoice& object) {
  const SiteSettings& site = config.site;
  const auto number = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return std::string(text);
  };
  std::string guide = "none";
  if (site.guide)
    guide = number(site.guide->x()) + ' ' + number(site.guide->y()) + ' ' + number(site.guide->z());
  std::vector<ConfigurationItem> items = {{"units", "SI"},
                                          {"adaptor", "preload"},
                                          {"object", object.name},
                                          {"damping", number(config.damping)},
                                          {"guide", guide}};
  for (const SiteKey& key : kSiteKeys) {
    const SiteField& field = findSiteField(key.field);
    if (field.is_shared) items.push_back({key.name, number(field.get(site))});
  }
  return makeConfiguration(std::move(items));
}

/// Text for the user about new status bits; null if there is nothing to do.
const char* describeStatus(std::uint32_t bits) {
  if (bits & kStateNotFinite) return "the motion is no longer finite; lower the gains";
  if (bits & kPacketRefused) return "the other site sends states that make no sense";
  if (bits & kBodyMissing) return "a body was taken out of the world during a step";
  return nullptr;
}

}  // namespace

SharedObject::SharedObject(const PreloadConfig& config) : config_(config) {
  if (!config_.log.empty()) log_ = std::make_unique<StepLog>(config_.log);
}

SharedObject::~SharedObject() = default;

void SharedObject::beforeStep() noexcept {
  if (has_given_up_) return;
  try {
    if (!site_) lookForObject();
    if (remote_) remote_->beginStep(site_time_.now());
    if (site_) seen_steps_ = site_->counters().host_steps;
  } catch (const std::exception& error) {
    giveUp(error.what());
  }
  is_in_step_ = true;
}

void SharedObject::lookForObject() {
  const ObjectChoice choice = chooseObject(*world_, config_, leave_alone_);
  if (!is_leaving_told_) reportLeaving(choice.body != nullptr);
  if (choice.body) return attach(choice);
  if (is_waiting_told_) return;
  is_waiting_told_ = true;
  say("world %d does not have the object of the config yet: waiting for it; its moving bodies: %s",
      config_.world, listObjects(*world_).c_str());
}

// The next step tells that the program runs on: at its end it takes all bodies out, which is no
// news.
void SharedObject::reportLeaving(bool is_back) {
  is_leaving_told_ = true;
  say("the object was taken out of world %d%s", config_.world,
      is_back ? ", and is back" : ": waiting for it to come back");
}

void SharedObject::attach(const ObjectChoice& choice) {
  if (config_.link && !remote_)
    remote_ = std::make_unique<RemoteSite>(config_, makeAgreement(config_, choice));
  device_ =
      std::make_unique<SimulatedDevice>(config_.device, makeConstantHand(config_.hand_force_W));
  site_ = std::make_unique<Site>(config_.site, *world_, *device_);
  site_->share(*choice.body, config_.damping);
  if (remote_)
    site_->connect(config_.link->peer, remote_->link(),
                   config_.remote_start_W.value_or(config_.device.start_W));
  choice_ = choice;
  body_ = choice.body;
  lookForTheSame(choice);
  site_time_ = {};
  reported_status_ = 0;
  say("shares moving body %d of world %d: %s", choice.index, config_.world, choice.name.c_str());
  if (choice.others > 0)
    say("%d more fit the config's object; the first in the world's order is taken", choice.others);
  for (const std::string& warning : site_->warnings()) say("note: %s", warning.c_str());
}

/// Looks for the same object by shape and mass from now on. Its index is valid only once: Bullet
/// moves the last body into the place of a removed one.
void SharedObject::lookForTheSame(const ObjectChoice& choice) {
  config_.index.reset();
  config_.shape = choice.shape;
  config_.mass = choice.mass;
}

void SharedObject::afterStep(double dt, int max_sub_steps, double fixed_step,
                             int sub_steps) noexcept {
  is_in_step_ = false;
  if (!site_) return;
  ++steps_;
  time_.advance(dt, max_sub_steps, fixed_step, sub_steps);
  site_time_.advance(dt, max_sub_steps, fixed_step, sub_steps);
  if (has_left_) return letGo();
  if (log_)
    log_->add(time_.now(), fromBullet(body_->getCenterOfMassPosition()), site_->force(),
              remote_ ? nameOf(site_->linkState(0)) : "none");
  try {
    report();
    if (site_->status() & kBodyMissing) return letGo();
    if (sub_steps > 0) attachAgainIfUnseated();
  } catch (const std::exception& error) {
    giveUp(error.what());
  }
}

void SharedObject::report() {
  const std::uint32_t news = site_->status() & ~reported_status_;
  reported_status_ |= news;
  if (const char* what = describeStatus(news)) say("%s", what);
  if (!remote_) return;
  if (const auto change = remote_->reportChange()) say("%s", change->c_str());
}

/// Attaches again if the program replaced the site's callback. A world has only one pre-tick
/// callback.
void SharedObject::attachAgainIfUnseated() {
  if (site_->counters().host_steps != seen_steps_) return;
  say("the program has set a tick callback of its own, which comes first now");
  site_.reset();
  attach(choice_);
}

void SharedObject::objectLeaves(const void* object) noexcept {
  // A new body may get the same address.
  std::erase(leave_alone_, object);
  const btCollisionObject* shared = body_;
  if (!site_ || object != shared) return;
  // A site cannot end within its own step.
  has_left_ = true;
  if (!is_in_step_) letGo();
}

void SharedObject::letGo() noexcept {
  last_ticks_ = site_->tickCount();
  site_.reset();
  device_.reset();
  has_left_ = false;
  is_waiting_told_ = true;
  try {
    leave_alone_ = findMovingBodies(*world_);
  } catch (const std::exception& error) {
    return giveUp(error.what());
  }
  std::erase(leave_alone_, body_);
  body_ = nullptr;
  is_leaving_told_ = false;
}

void SharedObject::giveUp(const char* why) noexcept {
  has_given_up_ = true;
  site_.reset();
  remote_.reset();
  body_ = nullptr;
  say("%s; the program runs on without Tandem", why);
}

void SharedObject::endWorld() noexcept {
  const bool was_shared = site_ || !is_leaving_told_;
  const unsigned long long ticks = site_ ? site_->tickCount() : last_ticks_;
  site_.reset();
  remote_.reset();
  log_.reset();
  body_ = nullptr;
  if (was_shared) {
    say("world %d ends after %llu steps with the object, %llu ticks in the last of its stays",
        config_.world, static_cast<unsigned long long>(steps_), ticks);
  } else if (!has_given_up_) {
    say("world %d ends; its object is not there", config_.world);
  }
}

}  // namespace tandem::preload
