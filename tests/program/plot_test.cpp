// `tandem plot` as a command: output paths, output text, exit status. tests/plot tests the content
// of the figures.

#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "program/process.h"
#include "program/tandem_program.h"

namespace tandem::test {
namespace {

class Plot : public ::testing::Test {
 protected:
  void SetUp() override {
    const Outcome outcome =
        runTandem({"run", scenarioPath("experiment1.toml"), "--set", "experiment.duration=0.05",
                   "--out", folder / "run", "--quiet"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }

  TempFolder folder;
};

TEST_F(Plot, WritesAReportAndPicturesAndPrintsWhere) {
  const Outcome outcome = runTandem({"plot", folder / "run"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, folder / "run/report.html\n");
  EXPECT_EQ(outcome.err, "");  // progress is for terminals
  std::vector<std::string> figures = listFolder(folder / "run/figures");
  // The film is there where the program is that draws it.
  const std::string view = std::filesystem::path(tandemProgram()).parent_path() / "tandem-view";
  EXPECT_EQ(std::erase(figures, "cooperation-film.gif"), std::filesystem::exists(view) ? 1u : 0u);
  EXPECT_EQ(figures,
            (std::vector<std::string>{"cooperation-coherency-over-time.png",
                                      "cooperation-coherency-over-time.svg",
                                      "cooperation-motion.png", "cooperation-motion.svg",
                                      "cooperation-top-view.png", "cooperation-top-view.svg"}));
  const std::string report = readFile(folder / "run/report.html");
  EXPECT_NE(report.find("data:image/svg+xml;base64,"), std::string::npos);
  EXPECT_NE(report.find("</html>"), std::string::npos);
}

TEST_F(Plot, SaysInOneLineWhatIsBroken) {
  folder.write("run/site1.csv", "t,object_x\n0\n");
  const Outcome outcome = runTandem({"plot", folder / "run"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "tandem: " + (folder / "run/site1.csv") +
                             ": line 2: 1 values, but the header names 2 columns\n");
  EXPECT_EQ(listFolder(folder / "run"),
            (std::vector<std::string>{"scene.csv", "site1.csv", "site2.csv", "summary.json"}));
}

TEST_F(Plot, NamesAFolderWithoutARun) {
  const Outcome outcome = runTandem({"plot", folder / "run", folder / "none"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err, "tandem: " + (folder / "none/summary.json") +
                             ": cannot be read; give folders that `tandem run --out` wrote\n");
}

}  // namespace
}  // namespace tandem::test
