// Private header of the plugin: sites agree on who takes part.
#include <vector>

#include <gtest/gtest.h>

#include "plugin/src/site/membership.h"
#include "support/random.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1.0 / 128.0;  // of packets [s]

PeerId idOf(std::size_t site) { return PeerId{static_cast<std::uint32_t>(site) + 1}; }

/// Sites that tell each other whom they hear, over ways that lose packets.
class Meeting {
 public:
  explicit Meeting(std::size_t sites, double loss = 0.0, double leave_after = 1.0)
      : settings_{true, leave_after}, loss_(loss), is_there_(sites, false) {
    for (std::size_t i = 0; i < sites; ++i) all_.emplace_back(idOf(i), settings_);
  }

  void come(std::size_t site) {
    all_[site] = Membership(idOf(site), settings_);
    is_there_[site] = true;
  }
  /// Goes with a farewell, which all hear.
  void leave(std::size_t site) {
    is_there_[site] = false;
    for (std::size_t i = 0; i < all_.size(); ++i)
      if (i != site) all_[i].forget(idOf(site));
  }
  void vanish(std::size_t site) { is_there_[site] = false; }
  /// The two hear nothing of each other from now on.
  void cut(std::size_t one, std::size_t other) { cuts_.push_back({one, other}); }
  void mend() { cuts_.clear(); }

  void run(double duration) {
    for (const double end = now_ + duration; now_ < end; now_ += kPeriod) {
      for (std::size_t from = 0; from < all_.size(); ++from)
        for (std::size_t to = 0; to < all_.size(); ++to) carry(from, to);
      for (std::size_t i = 0; i < all_.size(); ++i)
        if (is_there_[i]) changes_ += all_[i].agree(now_);
      for (Membership& one : all_)
        if (takes_over && one.leader() && one.isTied(*one.leader(), false)) one.endJoin();
    }
  }

  [[nodiscard]] const Membership& at(std::size_t site) const { return all_[site]; }
  [[nodiscard]] Membership& at(std::size_t site) { return all_[site]; }
  [[nodiscard]] int changes() const { return changes_; }

  /// Who joins has the objects of its leader at once when that one counts it.
  bool takes_over = false;

  /// Expects that those who are there, and nobody else, are tied in pairs.
  void expectAgreement() {
    int present = 0;
    for (const bool is_there : is_there_) present += is_there;
    takes_over = true;
    run(0.2);
    takes_over = false;
    for (std::size_t i = 0; i < all_.size(); ++i)
      if (is_there_[i]) {
        EXPECT_EQ(all_[i].count(), present) << i;
      }
    for (std::size_t i = 0; i < all_.size(); ++i)
      for (std::size_t k = 0; k < all_.size(); ++k)
        if (i != k && is_there_[i]) {
          EXPECT_EQ(all_[i].isTied(idOf(k), false), is_there_[k]) << i << k;
        }
  }

 private:
  void carry(std::size_t from, std::size_t to) {
    if (from == to || !is_there_[from] || !is_there_[to]) return;
    for (const auto& [one, other] : cuts_)
      if ((one == from && other == to) || (one == to && other == from)) return;
    if (random_.uniform(0.0, 1.0) >= loss_) all_[to].hear(idOf(from), all_[from].tell(now_), now_);
  }

  MembershipSettings settings_;
  double loss_, now_ = 0.0;
  std::vector<Membership> all_;
  std::vector<bool> is_there_;
  std::vector<std::pair<std::size_t, std::size_t>> cuts_;
  int changes_ = 0;
  test::Random random_{20};
};

TEST(MembersAgree, CountsOneWhileAlone) {
  const Membership alone(PeerId{3}, {true, 1.0});
  EXPECT_EQ(alone.count(), 1);
  EXPECT_FALSE(alone.isTied(PeerId{1}, false));
  EXPECT_TRUE(alone.tell(0.0)->heard.has(PeerId{3}));
}

TEST(MembersAgree, CountsEverybodyIfItIsFixed) {
  const Membership fixed(PeerId{3}, {});
  EXPECT_TRUE(fixed.isTied(PeerId{1}, true));
  EXPECT_FALSE(fixed.tell(0.0).has_value());
}

TEST(MembersAgree, OldestLeadsThoseWhoMeetAlone) {
  Meeting meeting(3);
  for (const std::size_t site : {1u, 0u, 2u}) {
    meeting.come(site);
    for (const std::size_t other : {0u, 1u, 2u})
      if (other != site) meeting.cut(site, other);
    meeting.run(0.1);
  }
  meeting.mend();
  meeting.run(0.1);
  EXPECT_FALSE(meeting.at(1).leader());
  EXPECT_EQ(meeting.at(0).leader(), PeerId{2});
  EXPECT_EQ(meeting.at(2).leader(), PeerId{2});
  // Who joins tells it only once it has the others' objects.
  EXPECT_FALSE(meeting.at(1).isTied(PeerId{1}, false));
  EXPECT_TRUE(meeting.at(0).isTied(PeerId{2}, false));
  meeting.expectAgreement();
}

TEST(MembersAgree, OneWhoIsAloneJoinsThoseWhoAreTogether) {
  Meeting meeting(3);
  meeting.come(1);
  meeting.come(2);
  meeting.run(0.1);
  meeting.expectAgreement();
  meeting.come(0);
  meeting.run(0.1);
  EXPECT_EQ(meeting.at(0).leader(), PeerId{2});
  EXPECT_FALSE(meeting.at(1).leader());
  meeting.expectAgreement();
}

TEST(MembersAgree, FarewellCountsAtOnceAndSilenceLater) {
  Meeting meeting(3);
  for (std::size_t i = 0; i < 3; ++i) meeting.come(i);
  meeting.run(0.1);
  meeting.expectAgreement();
  meeting.leave(1);
  meeting.run(0.05);
  EXPECT_EQ(meeting.at(0).count(), 2);
  meeting.vanish(2);
  meeting.run(0.9);
  EXPECT_EQ(meeting.at(0).count(), 2);
  meeting.run(0.2);
  EXPECT_EQ(meeting.at(0).count(), 1);
}

// Both ends of a torn way hear the third, which hears both: there is no set that hears itself.
TEST(MembersAgree, StaysWhereSomeDoNotHearEachOther) {
  Meeting meeting(3);
  for (std::size_t i = 0; i < 3; ++i) meeting.come(i);
  meeting.run(0.1);
  meeting.expectAgreement();
  const int changes = meeting.changes();
  meeting.cut(0, 1);
  meeting.run(3.0);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(meeting.at(i).count(), 3) << i;
  meeting.mend();
  meeting.run(0.1);
  EXPECT_EQ(meeting.changes(), changes);
  meeting.expectAgreement();
}

// Groups that lost each other count themselves; together again, both keep their objects.
TEST(MembersAgree, GroupsThatMeetAgainFollowNobody) {
  Meeting meeting(4);
  for (std::size_t i = 0; i < 4; ++i) meeting.come(i);
  meeting.run(0.1);
  meeting.expectAgreement();
  for (std::size_t one : {0u, 1u})
    for (std::size_t other : {2u, 3u}) meeting.cut(one, other);
  meeting.run(1.5);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(meeting.at(i).count(), 2) << i;
  meeting.mend();
  meeting.run(0.1);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_FALSE(meeting.at(i).leader()) << i;
  meeting.expectAgreement();
}

TEST(MembersAgree, OneThatRestartedJoinsAgain) {
  Meeting meeting(3);
  for (std::size_t i = 0; i < 3; ++i) meeting.come(i);
  meeting.run(0.1);
  meeting.expectAgreement();
  meeting.vanish(0);
  meeting.run(0.1);
  meeting.come(0);
  meeting.run(0.1);
  EXPECT_EQ(meeting.at(0).leader(), PeerId{2});
  EXPECT_FALSE(meeting.at(1).isTied(PeerId{1}, false));
  meeting.expectAgreement();
}

// The one that was to be followed begins anew, and is now the younger one.
TEST(MembersAgree, NobodyFollowsWhoFollowsHim) {
  Meeting meeting(2);
  meeting.come(1);
  meeting.run(0.1);
  meeting.come(0);
  meeting.run(0.1);
  EXPECT_EQ(meeting.at(0).leader(), PeerId{2});
  meeting.come(1);
  meeting.run(0.1);
  EXPECT_FALSE(meeting.at(0).leader());
  EXPECT_EQ(meeting.at(1).leader(), PeerId{1});
  meeting.expectAgreement();
}

TEST(MembersAgree, OneWhoseLeaderGoesFollowsAnother) {
  for (const bool says_farewell : {true, false}) {
    Meeting meeting(3, 0.0, 10.0);
    meeting.come(0);
    meeting.come(1);
    meeting.run(0.1);
    meeting.expectAgreement();
    meeting.come(2);
    meeting.run(0.1);
    EXPECT_EQ(meeting.at(2).leader(), PeerId{1});
    says_farewell ? meeting.leave(0) : meeting.vanish(0);
    meeting.run(says_farewell ? 0.05 : 1.1);
    EXPECT_EQ(meeting.at(2).leader(), PeerId{2}) << says_farewell;
    EXPECT_EQ(meeting.at(2).tell(0.0)->members.count(), 1);
    if (says_farewell) meeting.expectAgreement();
  }
}

// Alone again before it had anything: it keeps what it has, and joins the next.
TEST(MembersAgree, OneWhoIsLeftAloneWhileItJoinsJoinsTheNext) {
  Meeting meeting(3);
  meeting.come(0);
  meeting.run(0.1);
  meeting.come(1);
  meeting.run(0.1);
  EXPECT_EQ(meeting.at(1).leader(), PeerId{1});
  meeting.leave(0);
  meeting.run(0.05);
  EXPECT_FALSE(meeting.at(1).leader());
  EXPECT_EQ(meeting.at(1).count(), 1);
  meeting.come(2);
  meeting.run(0.1);
  EXPECT_EQ(meeting.at(2).leader(), PeerId{2});
  meeting.expectAgreement();
}

TEST(MembersAgree, LeaversCountNoMoreThoughANewcomerIsNotHeardByAll) {
  Meeting meeting(4);
  for (std::size_t i = 0; i < 3; ++i) meeting.come(i);
  meeting.run(0.1);
  meeting.expectAgreement();
  meeting.come(3);
  meeting.cut(2, 3);
  meeting.run(0.5);
  EXPECT_EQ(meeting.at(0).count(), 3);
  EXPECT_EQ(meeting.at(3).count(), 1);
  meeting.leave(1);
  meeting.run(0.05);
  EXPECT_EQ(meeting.at(0).count(), 2);
  EXPECT_EQ(meeting.at(2).count(), 2);
  EXPECT_EQ(meeting.at(3).count(), 1);
  meeting.mend();
  meeting.run(0.1);
  EXPECT_EQ(meeting.at(3).leader(), PeerId{1});
  meeting.expectAgreement();
}

TEST(MembersAgree, EverybodyAgreesAfterAnyComingAndGoing) {
  constexpr std::size_t kSites = 8;
  test::Random random(2020);
  for (int run = 0; run < 50; ++run) {
    Meeting meeting(kSites, 0.2);
    std::vector<bool> is_there(kSites, false);
    for (int change = 0; change < 30; ++change) {
      const auto site = static_cast<std::size_t>(random.uniform(0.0, kSites - 1e-9));
      if (!is_there[site]) {
        meeting.come(site);
      } else if (random.uniform(0.0, 1.0) < 0.5) {
        meeting.leave(site);
      } else {
        meeting.vanish(site);
      }
      is_there[site] = !is_there[site];
      meeting.takes_over = random.uniform(0.0, 1.0) < 0.5;
      if (run % 2 == 1 && change % 5 == 0)
        meeting.cut(site, static_cast<std::size_t>(random.uniform(0.0, kSites - 1e-9)));
      meeting.run(random.uniform(0.0, 0.3));
    }
    meeting.mend();
    meeting.run(2.0);
    meeting.expectAgreement();
    if (HasFailure()) FAIL() << "run " << run;
  }
}

}  // namespace
}  // namespace tandem
