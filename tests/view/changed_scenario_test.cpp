// Changes of scheme and gains that sites tell each other. Texts of the other site are not trusted.

#include "peer/changed_scenario.h"

#include <string>

#include <gtest/gtest.h>

#include "peer/peer_configuration.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

const std::string kGood =
    "7 experiment.scheme=kinematic_proxy contact.stiffness=1500.0 contact.damping=2.0 "
    "coordination.stiffness=100.0 coordination.damping=5.0";

/// A site that has made `changes` changes.
ChangedScenario makeOwn(std::uint32_t changes) {
  return {parseScenario("title = \"own\"", "own.toml", {}), changes};
}

ConfigurationDifference tell(const std::string& there) { return {kChangeKey, "", there}; }

std::string replaceIn(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

TEST(ChangedScenario, TellsWhatTheOtherFollows) {
  const ChangedScenario own = makeOwn(3);
  const Scenario wanted = changeScenario(
      own.scenario, {"experiment.scheme=virtual_coupling", "coordination.damping=12.3456789"});
  const ChangedScenario next = proposeChange(own, wanted);
  EXPECT_EQ(next.changes, 4u);
  const auto item = describeChange(next);
  ASSERT_TRUE(item);
  EXPECT_NO_THROW((void)makeConfiguration({*item}));
  const auto followed = followChange(makeOwn(0), tell(item->value));
  ASSERT_TRUE(followed);
  EXPECT_EQ(followed->changes, 4u);
  EXPECT_EQ(makePeerConfiguration(followed->scenario), makePeerConfiguration(wanted));
  EXPECT_EQ(describeChange(*followed)->value, item->value) << "so that both then agree";
}

TEST(ChangedScenario, SpectatorsHashIsOfWhatStays) {
  const Scenario own = makeOwn(0).scenario;
  const auto hash = [&](const std::string& value) {
    return hashWatchedScenario(changeScenario(own, {value}));
  };
  for (const char* changes : {"experiment.scheme=kinematic_proxy", "contact.damping=2",
                              "coordination.stiffness=100", "site=[{}, {}, {}]", "title=other"})
    EXPECT_EQ(hash(changes), hashWatchedScenario(own)) << changes;
  for (const char* stays : {"object.size=0.05", "object.mass=0.3", "experiment.axis=[0, 1, 0]"})
    EXPECT_NE(hash(stays), hashWatchedScenario(own)) << stays;
}

TEST(ChangedScenario, SaysNothingBeforeTheFirstChange) { EXPECT_FALSE(describeChange(makeOwn(0))); }

// Peers tell their first difference only while they do not know all.
TEST(ChangedScenario, SortsBeforeAllKeysOfAScenario) {
  for (const ConfigurationItem& item : makePeerConfiguration(makeOwn(0).scenario))
    EXPECT_LT(std::string(kChangeKey), item.key);
}

TEST(ChangedScenario, FollowsTheNewerOneAndOfTwoTheFirstByText) {
  EXPECT_TRUE(followChange(makeOwn(6), tell(kGood)));
  const std::string earlier = replaceIn(kGood, "1500.0", "1400.0");
  EXPECT_FALSE(followChange(makeOwn(7), {kChangeKey, earlier, kGood}));
  EXPECT_TRUE(followChange(makeOwn(7), {kChangeKey, kGood, earlier}));
  EXPECT_FALSE(followChange(makeOwn(7), {kChangeKey, kGood, kGood}));
  EXPECT_FALSE(followChange(makeOwn(8), tell(kGood)));
  EXPECT_FALSE(followChange(makeOwn(0), tell(""))) << "the other has made no change";
  EXPECT_FALSE(followChange(makeOwn(0), {"object.mass", "1", "2"})) << "another scenario";
}

TEST(ChangedScenario, RefusesValuesThatNoFileCouldHave) {
  const ChangedScenario own = makeOwn(0);
  ASSERT_TRUE(followChange(own, tell(kGood)));
  for (const char* value : {"-1.0", "nan", "inf", "1e300", "[1]", "true", "''", "0x", "{}"})
    EXPECT_THROW((void)followChange(own, tell(replaceIn(kGood, "1500.0", value))), UsageError)
        << value;
  for (const char* value : {"no_such_scheme", "7", "../../x"})
    EXPECT_THROW((void)followChange(own, tell(replaceIn(kGood, "kinematic_proxy", value))),
                 UsageError)
        << value;
}

TEST(ChangedScenario, RefusesTextsThatAreNoChange) {
  const ChangedScenario own = makeOwn(0);
  for (const std::string& text :
       {std::string("7"), std::string("x"), std::string("7 "), kGood.substr(0, 60),
        kGood + " object.mass=9", replaceIn(kGood, "7 ", "0 "), replaceIn(kGood, "7 ", "-7 "),
        replaceIn(kGood, "7 ", "1000000000 "), replaceIn(kGood, "7 ", "99999999999999999999 "),
        replaceIn(kGood, "contact.stiffness", "object.mass"),
        replaceIn(kGood, "contact.damping", "contact.stiffness")})
    EXPECT_THROW((void)followChange(own, tell(text)), UsageError) << text;
}

TEST(ChangedScenario, ChangesSchemeAndGainsOnly) {
  const ChangedScenario own = makeOwn(0);
  EXPECT_THROW((void)proposeChange(own, changeScenario(own.scenario, {"object.mass=9"})),
               UsageError);
  EXPECT_THROW((void)proposeChange(makeOwn(999'999'999), own.scenario), UsageError);
}

}  // namespace
}  // namespace tandem::demos
