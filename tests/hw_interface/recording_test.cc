#include "vmech/hw_interface/loop/recording.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <stdexcept>

#include "support/temp_folder.h"
#include "vmech/hw_interface/loop/replay_master.h"

namespace vmech {
namespace {

class RecordingFile : public testing::Test {
 protected:
  static Recording Sample() {
    Recording recording;
    recording.device = "a device, with a comma";
    recording.channels = {"closure", "bearing pin"};
    for (int k = 0; k < 3; ++k) {
      TickRecord tick;
      tick.state.sequence = 100 + k;
      tick.state.host_time_ns = 1'000'000'000'000'001 + k;
      tick.state.valid = kSensesPose | kSensesAppliedWrench;
      tick.state.dead_man = true;
      tick.state.X_DH.p = Vector3d(0.1 / 3, -k, 1e-17);
      tick.state.X_DH.R =
          Eigen::AngleAxisd(0.3 + k, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
      tick.wanted_F_Ho_D[5] = -1.0 / 7;
      tick.off = ForceOff::kSpeed;
      tick.channels = {1e-300, 2.5};
      recording.ticks.push_back(tick);
    }
    recording.delay = 2e-3;
    recording.linear = {0.8, 0.3, 0, 1e-4, 130, std::numeric_limits<double>::infinity()};
    recording.notes = {{"file", "a mechanism.yaml"}, {"grasp", ""}};
    return recording;
  }

  std::string ErrorOf(const std::string& text) {
    std::ofstream(file_) << text;
    try {
      ReadRecording(file_);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  TempFolder folder_;
  std::filesystem::path file_ = folder_ / "recording.csv";
};

TEST_F(RecordingFile, ComesBackAsItWas) {
  const Recording before = Sample();
  WriteRecording(file_, before);
  const Recording after = ReadRecording(file_);
  EXPECT_EQ(after.device, before.device);
  EXPECT_EQ(after.channels, before.channels);
  EXPECT_EQ(after.delay, before.delay);
  EXPECT_EQ(after.linear.mass, before.linear.mass);
  EXPECT_EQ(after.linear.max_speed, before.linear.max_speed);
  EXPECT_EQ(after.Note("file"), "a mechanism.yaml");
  EXPECT_EQ(after.Note("grasp"), "");
  ASSERT_EQ(after.ticks.size(), 3u);
  for (int k = 0; k < 3; ++k) {
    const TickRecord &a = after.ticks[k], &b = before.ticks[k];
    EXPECT_EQ(a.state.host_time_ns, b.state.host_time_ns);
    EXPECT_EQ(a.state.valid, b.state.valid);
    EXPECT_EQ(a.state.X_DH.p, b.state.X_DH.p);
    EXPECT_LT((a.state.X_DH.R - b.state.X_DH.R).norm(), 1e-15);
    EXPECT_EQ(a.wanted_F_Ho_D, b.wanted_F_Ho_D);
    EXPECT_EQ(a.off, ForceOff::kSpeed);
    EXPECT_EQ(a.channels, b.channels);
  }
}

TEST_F(RecordingFile, ErrorsNameTheLineAndTheColumn) {
  WriteRecording(file_, Sample());
  std::ifstream in(file_);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  text.replace(text.rfind("101,"), 3, "1o1");
  EXPECT_EQ(ErrorOf(text), file_.string() + ":11: column 'sequence': '1o1' is not a number");
  EXPECT_EQ(ErrorOf("hello\n"), file_.string() + ":1: '# vmech recording 1' expected");
  EXPECT_EQ(ErrorOf("# vmech recording 1\n# device x\n# period 0.001\na,b\n"),
            file_.string() + ":4: these are not the columns of a recording");
  EXPECT_EQ(ErrorOf("# vmech recording 1\n# device x\n# period 0.001\n# colour blue\n"),
            file_.string() + ":4: '# colour': delay, linear, angular or note expected");
}

TEST_F(RecordingFile, ReplayGivesSampleAfterSampleAndThenNoMore) {
  ReplayMaster master(Sample());
  master.Configure();
  master.Activate();
  MasterState state;
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(master.Read(k, &state), IoStatus::kOk);
    EXPECT_EQ(state.X_DH.p.y(), -k);
    EXPECT_EQ(state.valid, kSensesPose);  // no wrench is at work
  }
  EXPECT_TRUE(master.finished());
  EXPECT_EQ(master.Read(3, &state), IoStatus::kNoNewData);
  EXPECT_EQ(state.X_DH.p.y(), -2);
}

TEST_F(RecordingFile, SessionComesBackWithItsDeviceAndTheWrenchAtWork) {
  ReplayMaster master(Sample(), ReplayKind::kSession);
  master.Configure();
  EXPECT_EQ(master.info().linear.mass, 0.8);
  EXPECT_EQ(master.info().delay, 2e-3);
  EXPECT_TRUE(master.info().senses & kSensesAppliedWrench);
}

TEST(ReplayMaster, RefusesAnEmptyRecording) {
  EXPECT_THROW(ReplayMaster(Recording{}), std::invalid_argument);
}

}  // namespace
}  // namespace vmech
