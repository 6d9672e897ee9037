// `tandem link`: start, refusals and end.

#include <algorithm>
#include <csignal>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program/link_rig.h"
#include "program/tandem_program.h"

namespace tandem::test {
namespace {

using Words = std::vector<std::string>;

void expectRefused(const Outcome& outcome, const Words& words) {
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  for (const std::string& word : words)
    EXPECT_NE(outcome.err.find(word), std::string::npos) << '"' << word << "\" in: " << outcome.err;
}

/// Runs the link with an end, in case it does start.
Outcome runLink(Words arguments) {
  arguments.insert(arguments.begin(), "link");
  arguments.insert(arguments.end(), {"--for", "0"});
  return runTandem(arguments);
}

Outcome runWith(const Words& more) {
  Words arguments = {"--listen", "127.0.0.1:0", "--forward", "127.0.0.1:9"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return runLink(arguments);
}

TEST(LinkUse, EndsWithATableOnASignal) {
  for (const int signal : {SIGINT, SIGTERM}) {
    LinkRig rig({"--delay", "1ms"});
    rig.client.send(makeDatagram(0), rig.proxy);
    ASSERT_TRUE(rig.server.receive(kPatience));
    const Outcome outcome = rig.link.finish(signal);
    EXPECT_EQ(outcome.status, 0);
    for (const char* word : {"forward:", "back:", "asked", "came out", "datagrams", "lost",
                             "delay, mean", "1.000 ms", "self-latency, 99 %", "overflowed"})
      EXPECT_NE(outcome.out.find(word), std::string::npos) << word << " in:\n" << outcome.out;
  }
}

TEST(LinkUse, EndsByItselfAfterItsTime) {
  const Outcome outcome = runWith({});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find("listening on 127.0.0.1:"), 0U) << outcome.out;
  EXPECT_NE(outcome.out.find("datagrams"), std::string::npos) << outcome.out;
}

TEST(LinkUse, PrintsJsonAloneToStandardOutput) {
  const Outcome outcome = runWith({"--json"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.err.find("listening on "), std::string::npos);
  const auto report = nlohmann::json::parse(outcome.out);
  for (const char* lane : {"forward", "back"})
    for (const char* part : {"asked", "achieved", "self_latency", "counts"})
      EXPECT_TRUE(report[lane][part].is_object()) << lane << ' ' << part;
  EXPECT_TRUE(report["forward"]["achieved"]["loss"].is_null());  // there was no datagram
}

TEST(LinkUse, CanBeQuiet) {
  const Outcome outcome = runWith({"--quiet"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "");
}

TEST(LinkUse, RefusesBadValues) {
  expectRefused(runWith({"--delay", "50"}), {"--delay 50", "0s to 10s", "50ms"});
  expectRefused(runWith({"--delay=-5ms"}), {"--delay -5ms", "50ms"});
  expectRefused(runWith({"--jitter", "5 ms"}), {"--jitter 5 ms", "50ms"});
  expectRefused(runWith({"--loss", "2"}), {"--loss 2", "0% to 100%", "2%"});
  expectRefused(runWith({"--duplicate", "101%"}), {"--duplicate 101%", "0% to 100%"});
  expectRefused(runWith({"--reorder", "nan"}), {"--reorder nan", "0% to 100%"});
  expectRefused(runWith({"--corrupt", ""}), {"--corrupt", "0% to 100%"});
  expectRefused(runWith({"--seed", "-1"}), {"--seed -1", "whole number"});
  expectRefused(runTandem({"link", "--listen", ":0", "--forward", "127.0.0.1:9", "--for", "long"}),
                {"--for long", "seconds"});
}

TEST(LinkUse, RefusesBadAddresses) {
  expectRefused(runLink({}), {"--listen", "--help"});
  expectRefused(runLink({"--listen", ":0"}), {"--forward", "--help"});
  expectRefused(runLink({"--listen", "7002", "--forward", ":9"}), {"--listen", "port is missing"});
  expectRefused(runLink({"--listen", ":0", "--forward", "127.0.0.1:70000"}),
                {"--forward", "0 to 65535"});
  expectRefused(runLink({"--listen", ":0", "--forward", "127.0.0.1:0"}),
                {"--forward", "1 to 65535"});
}

TEST(LinkUse, RefusesAPortInUseAndItself) {
  const Endpoint taken;
  const std::string address = toString(taken.address());
  expectRefused(runLink({"--listen", address, "--forward", "127.0.0.1:9"}),
                {address, "another port"});
  std::string free;
  {
    const Endpoint found;
    free = toString(found.address());
  }
  expectRefused(runLink({"--listen", free, "--forward", free}), {free, "address of the server"});
  const std::string port = free.substr(free.rfind(':'));
  expectRefused(runLink({"--listen", port, "--forward", free}), {free, "address of the server"});
}

TEST(LinkUse, RefusesABadScript) {
  const TempFolder folder;
  expectRefused(runWith({"--script", folder / "missing.toml"}), {"missing.toml", "script"});
  const std::string bad = folder.write("bad.toml", "[[change]]\nat = 1.0\nloss = \"200%\"\n");
  expectRefused(runWith({"--script", bad}), {bad, "change 1.loss", "200%", "0% to 100%"});
}

}  // namespace
}  // namespace tandem::test
