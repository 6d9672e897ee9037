#include "stability/loop_model.h"

#include <algorithm>

#include "schemes/coordination_shares.h"

// One axis, all contacts closed. With n = N - 1 others, R what a site hears, s the share of a
// stand-in and w that of a coupler:
//
//   (m_dev + m_hand) vd' = f - (b_dev + B_h) vd - K_h xd
//   m_h vp' = K_t (sum_j R_j d_j / n - xp) + B_t (..)' - b_h vp + K_vc (xo - xp) + B_vc (..)'
//   (m/N) vo' = K_vc (hx - xo) + B_vc (..)' - b vo + w [K_t (sum_j R_j o_j - n xo) + B_t (..)']
//             + n s [K_vc (xp - xo) + B_vc (..)']          of proxies, or
//             + s [K_vc (sum_j R_j d_j - n xo) + B_vc (..)']   of held bodies
//   f = K_vc (xo - hx) + B_vc (vo - hv), taken at a tick
//
// Without an object, the proxies or held bodies take its place at the hand. All proxies of a site
// are alike, so their mean stands for them: their differences are lone oscillators.
namespace tandem::stability {
namespace {

/// A spring-damper's force on the values at `on`, as a row: K (x_from - x_on) + B (..)'.
struct Row {
  Eigen::RowVectorXd& row;

  void add(int place, double stiffness, double damping) {
    row(place) += stiffness;
    row(place + 1) += damping;
  }
  void pull(int from, int on, const CouplerGains& gains, double share = 1.0) {
    add(from, share * gains.stiffness, share * gains.damping);
    add(on, -share * gains.stiffness, -share * gains.damping);
  }
};

double findDelay(const LoopSettings& s, std::size_t from, std::size_t to) {
  const bool is_own = !s.areUsersAlike() && !s.each[from].delays.empty();
  return is_own ? s.delay * s.each[from].delays[to] : s.delay;
}

/// Packets of a site that take equally long are one channel.
std::size_t addChannel(LoopModel& model, const Channel& wanted) {
  std::vector<Channel>& all = model.channels;
  const auto known = std::find_if(all.begin(), all.end(), [&](const Channel& channel) {
    return channel.source == wanted.source && channel.delay == wanted.delay;
  });
  if (known != all.end()) return static_cast<std::size_t>(known - all.begin());
  all.push_back(wanted);
  return all.size() - 1;
}

CouplerGains findContact(const LoopSettings& s, int site) {
  if (s.areUsersAlike()) return s.contact;
  const LoopUser& user = s.each[static_cast<std::size_t>(site)];
  return {user.contact_stiffness * s.contact.stiffness, user.contact_damping * s.contact.damping};
}

double findStandInShare(const LoopSettings& s) {
  return s.stand_in_share.value_or(computeShares(s.mode, s.users).stand_in);
}

}  // namespace

LoopModel makeModeModel(const LoopSettings& settings, MotionMode mode) {
  if (!settings.areUsersAlike()) {
    LoopModel model = makeFullModel(settings);
    if (mode == MotionMode::kDeaf) model.weights.setZero();
    return model;
  }
  LoopModel model{settings, 1, {{0, settings.delay, 0.0}}, Eigen::MatrixXd::Zero(1, 1)};
  if (mode == MotionMode::kCommon) model.weights(0, 0) = settings.users - 1.0;
  if (mode == MotionMode::kDifference) model.weights(0, 0) = -1.0;
  return model;
}

LoopModel makeFullModel(const LoopSettings& settings, const std::vector<double>& phases) {
  const auto users = static_cast<std::size_t>(settings.users);
  LoopModel model;
  model.settings = settings;
  model.sites = settings.users;
  std::vector<std::vector<std::size_t>> heard(users);  // channels, by who hears
  for (std::size_t from = 0; from < users; ++from)
    for (std::size_t to = 0; to < users; ++to) {
      if (from == to) continue;
      const double phase = phases.empty() ? 0.0 : phases[from];
      heard[to].push_back(
          addChannel(model, {static_cast<int>(from), findDelay(settings, from, to), phase}));
    }
  model.weights = Eigen::MatrixXd::Zero(settings.users, static_cast<int>(model.channels.size()));
  for (std::size_t to = 0; to < users; ++to)
    for (const std::size_t channel : heard[to])
      model.weights(static_cast<int>(to), static_cast<int>(channel)) = 1.0;
  return model;
}

LoopSystem::LoopSystem(const LoopModel& model) {
  placeAll(model);
  for (int i = 0; i < model.sites; ++i) {
    addDevice(model, i);
    if (site(i).proxy >= 0) addProxy(model, i);
    if (site(i).object >= 0) addObject(model, i);
    addForce(model, i);
  }
}

void LoopSystem::placeAll(const LoopModel& model) {
  const LoopSettings& s = model.settings;
  int size = 0;
  const auto place = [&](bool exists) {
    if (!exists) return -1;
    size += 2;
    return size - 2;
  };
  for (int i = 0; i < model.sites; ++i) {
    SitePlaces& site = sites_.emplace_back();
    site.device = place(true);
    site.hip = place(true);
    site.force = size++;
    site.object = place(s.has_object);
    site.proxy = place(s.stand_in == StandInKind::kDynamic);
  }
  for (std::size_t c = 0; c < model.channels.size(); ++c) {
    ChannelPlaces& channel = channels_.emplace_back();
    channel.device = place(s.stand_in != StandInKind::kNone);
    channel.object = place(s.has_object);
  }
  rates_ = Eigen::MatrixXd::Zero(size + 1, size + 1);
}

void LoopSystem::addDevice(const LoopModel& model, int i) {
  const LoopSettings& s = model.settings;
  const SitePlaces& at = site(i);
  const LoopUser user = s.areUsersAlike() ? LoopUser() : s.each[static_cast<std::size_t>(i)];
  const double mass = user.device_mass * s.device_mass + s.hand.mass;
  const double damping = user.device_damping * s.device_damping + s.hand.damping;
  rates_(at.device, at.device + 1) = 1.0;
  rates_(at.device + 1, at.device) = -s.hand.stiffness / mass;
  rates_(at.device + 1, at.device + 1) = -damping / mass;
  rates_(at.device + 1, at.force) = 1.0 / mass;
  rates_(at.device + 1, push()) = 1.0 / mass;
  rates_(at.hip, at.hip + 1) = 1.0;
}

void LoopSystem::addProxy(const LoopModel& model, int i) {
  const LoopSettings& s = model.settings;
  const SitePlaces& at = site(i);
  const CouplerGains contact = findContact(s, i);
  const double others = s.users - 1.0;
  Eigen::RowVectorXd force = Eigen::RowVectorXd::Zero(size());
  Row row{force};
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const double share = model.weights(i, static_cast<Eigen::Index>(c)) / others;
    row.add(channels_[c].device, share * s.coordination.stiffness, share * s.coordination.damping);
  }
  row.add(at.proxy, -s.coordination.stiffness, -s.coordination.damping - s.proxy_damping);
  row.pull(s.has_object ? at.object : at.hip, at.proxy, contact);
  rates_(at.proxy, at.proxy + 1) = 1.0;
  rates_.row(at.proxy + 1) = force / s.proxy_mass;
}

void LoopSystem::addObject(const LoopModel& model, int i) {
  const LoopSettings& s = model.settings;
  const SitePlaces& at = site(i);
  const CouplerGains contact = findContact(s, i);
  const double others = s.users - 1.0, stand_in = findStandInShare(s);
  const double share = computeShares(s.mode, s.users).object;
  Eigen::RowVectorXd force = Eigen::RowVectorXd::Zero(size());
  Row row{force};
  row.pull(at.hip, at.object, contact);
  row.add(at.object, -share * others * s.coordination.stiffness,
          -share * others * s.coordination.damping - s.object_damping);
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const double heard = model.weights(i, static_cast<Eigen::Index>(c));
    row.add(channels_[c].object, share * heard * s.coordination.stiffness,
            share * heard * s.coordination.damping);
    if (s.stand_in == StandInKind::kHeld)
      row.add(channels_[c].device, stand_in * heard * contact.stiffness,
              stand_in * heard * contact.damping);
  }
  if (s.stand_in == StandInKind::kHeld)
    row.add(at.object, -stand_in * others * contact.stiffness,
            -stand_in * others * contact.damping);
  if (at.proxy >= 0) row.pull(at.proxy, at.object, contact, stand_in * others);
  rates_(at.object, at.object + 1) = 1.0;
  rates_.row(at.object + 1) = force / (s.object_mass / s.users);
}

void LoopSystem::addForce(const LoopModel& model, int i) {
  const LoopSettings& s = model.settings;
  const SitePlaces& at = site(i);
  const CouplerGains contact = findContact(s, i);
  const double others = s.users - 1.0, stand_in = findStandInShare(s);
  Eigen::RowVectorXd& force = forces_.emplace_back(Eigen::RowVectorXd::Zero(size()));
  Row row{force};
  if (s.has_object) return row.pull(at.object, at.hip, contact);
  if (at.proxy >= 0) return row.pull(at.proxy, at.hip, contact, stand_in * others);
  row.add(at.hip, -stand_in * others * contact.stiffness, -stand_in * others * contact.damping);
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const double heard = stand_in * model.weights(i, static_cast<Eigen::Index>(c));
    row.add(channels_[c].device, heard * contact.stiffness, heard * contact.damping);
  }
}

}  // namespace tandem::stability
