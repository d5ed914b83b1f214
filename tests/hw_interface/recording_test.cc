#include "vmech/hw_interface/recording/recording_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>

#include "support/temp_folder.h"
#include "vmech/hw_interface/loop/replay_master.h"
#include "vmech/hw_interface/recording/columns.h"
#include "vmech/hw_interface/recording/mcap_records.h"
#include "vmech/hw_interface/recording/tick_recorder.h"

namespace vmech::recording_test {
namespace {

TickRecord SampleTick(int k) {
  TickRecord tick;
  tick.state.sequence = 100 + k;
  tick.state.host_time_ns = 1'000'000'000'000'001 + 1'000'000LL * k;
  tick.state.valid = kSensesPose | kSensesAppliedWrench;
  tick.state.dead_man = true;
  tick.state.X_DH.p = Vector3d(0.1 / 3, -k, 1e-17);
  tick.state.X_DH.R = Eigen::AngleAxisd(0.3 + k, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  tick.wanted_F_Ho_D[5] = -1.0 / 7;
  tick.off = ForceOff::kSpeed;
  tick.io = IoStatus::kNoNewData;
  tick.stages = kRamped | kSlewed;
  tick.observed = true;
  tick.hand.X_DH.R = tick.state.X_DH.R.transpose();
  tick.hand.V_DH[4] = 1.0 / 3;
  tick.registration.X_WD.p = Vector3d(1, 2, 3);
  tick.stored_energy = -2.0 / 3;
  tick.picture.q = VectorXd::Constant(1, 0.1 * k);
  tick.picture.v = VectorXd::Constant(1, 1.0 / 7);
  tick.picture.joints = {{Vector3d(1, 2, 3), Vector3d(-1e-9, 0, 1.0 / 3)}};
  tick.picture.holds = false;
  tick.channels = {1e-300, 2.5, static_cast<double>(k % 2)};
  return tick;
}

Recording Sample(int ticks = 3) {
  Recording recording;
  recording.device = "a device, with a comma";
  recording.channels = {"closure", "bearing pin", "state"};
  recording.states = {"moves", "stopped"};
  recording.mechanism = {"vmech: \"1.0\"\n  # a text\n", {"pin"}, {"pin"}, {"pin"}};
  recording.delay = 2e-3;
  recording.linear = {0.8, 0.3, 0, 1e-4, 130, std::numeric_limits<double>::infinity()};
  recording.notes = {{"file", "a mechanism.yaml"}, {"grasp", ""}};
  for (int k = 0; k < ticks; ++k) recording.ticks.push_back(SampleTick(k));
  return recording;
}

std::string RowOf(const Recording& recording, const TickRecord& tick) {
  std::string row;
  AppendRow(recording, tick, &row);
  return row;
}

std::string TextOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class RecordingFile : public testing::Test {
 protected:
  std::string ErrorOf(const std::string& text) {
    std::ofstream(file_, std::ios::binary) << text;
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

class EitherFormat : public RecordingFile, public testing::WithParamInterface<const char*> {};

TEST_P(EitherFormat, ComesBackToTheLastBit) {
  file_ = folder_ / GetParam();
  const Recording before = Sample();
  WriteRecording(file_, before);
  const Recording after = ReadRecording(file_);
  EXPECT_EQ(after.device, before.device);
  EXPECT_EQ(after.channels, before.channels);
  EXPECT_EQ(after.states, before.states);
  EXPECT_EQ(after.delay, before.delay);
  EXPECT_EQ(after.linear.mass, before.linear.mass);
  EXPECT_EQ(after.linear.max_speed, before.linear.max_speed);
  EXPECT_EQ(after.notes, before.notes);
  EXPECT_EQ(after.mechanism.text, before.mechanism.text);
  EXPECT_EQ(after.mechanism.joints, before.mechanism.joints);
  EXPECT_TRUE(after.complete);
  ASSERT_EQ(after.ticks.size(), 3u);
  for (int k = 0; k < 3; ++k) {
    const TickRecord &a = after.ticks[k], &b = before.ticks[k];
    EXPECT_EQ(a.state.X_DH.R, b.state.X_DH.R);
    EXPECT_EQ(a.hand.X_DH.R, b.hand.X_DH.R);
    EXPECT_EQ(a.off, ForceOff::kSpeed);
    EXPECT_EQ(a.io, IoStatus::kNoNewData);
    EXPECT_EQ(RowOf(after, a), RowOf(before, b));
  }
}

/// Of a fault there may be such numbers.
TEST_P(EitherFormat, KeepsNumbersThatAreNone) {
  file_ = folder_ / GetParam();
  Recording before = Sample(1);
  before.ticks[0].energy = std::nan("");
  before.ticks[0].sent_F_Ho_D[0] = -std::numeric_limits<double>::infinity();
  WriteRecording(file_, before);
  const Recording after = ReadRecording(file_);
  EXPECT_TRUE(std::isnan(after.ticks[0].energy));
  EXPECT_EQ(after.ticks[0].sent_F_Ho_D[0], -std::numeric_limits<double>::infinity());
}

TEST_P(EitherFormat, AFileThatWasCutShortGivesItsWholeTicks) {
  file_ = folder_ / GetParam();
  WriteRecording(file_, Sample(2000));
  const std::string whole = TextOf(file_);
  for (const double share : {0.05, 0.3, 0.5, 0.9}) {
    std::ofstream(file_, std::ios::binary)
        << whole.substr(0, static_cast<size_t>(share * static_cast<double>(whole.size())));
    const Recording cut = ReadRecording(file_);
    EXPECT_FALSE(cut.complete);
    EXPECT_LT(cut.ticks.size(), 2000u);
    for (size_t k = 0; k < cut.ticks.size(); ++k) EXPECT_EQ(cut.ticks[k].state.sequence, 100 + k);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, EitherFormat, testing::Values("a.csv", "a.mcap"));

TEST_F(RecordingFile, StatesAreNamed) {
  WriteRecording(file_, Sample());
  const std::string text = TextOf(file_);
  EXPECT_NE(text.find(",no new data,too fast,ramped+slewed,"), std::string::npos);
  EXPECT_NE(text.find(",stopped\n"), std::string::npos);
  EXPECT_NE(text.find("\n# end 3 ticks, 0 lost\n"), std::string::npos);
}

TEST_F(RecordingFile, ErrorsNameTheLineAndTheColumn) {
  WriteRecording(file_, Sample());
  std::string text = TextOf(file_);
  text.replace(text.rfind("101,"), 3, "1o1");
  EXPECT_NE(ErrorOf(text).find(": column 'sequence': '1o1' is not a number"), std::string::npos);
  EXPECT_EQ(ErrorOf("hello\n"), file_.string() + ":1: '# vmech recording 2' (or 1) expected");
  EXPECT_EQ(ErrorOf("# vmech recording 2\n# device x\n# period 0.001\na,b\n"),
            file_.string() + ":4: these are not the columns of a recording");
  EXPECT_NE(ErrorOf("# vmech recording 2\n# device x\n# colour blue\n").find(":3: 'colour'"),
            std::string::npos);
}

TEST_F(RecordingFile, ADamagedMcapFileIsRefused) {
  file_ = folder_ / "a.mcap";
  WriteRecording(file_, Sample());
  std::string text = TextOf(file_);
  const size_t place = text.find("\"energy\":");
  text[place + 9] ^= 1;
  EXPECT_NE(ErrorOf(text).find("wrong CRC"), std::string::npos);
}

/// The check value of the catalogue of CRC algorithms.
TEST(Mcap, HasTheCrcOfEthernet) {
  EXPECT_EQ(Crc32(0, "123456789"), 0xCBF43926u);
  EXPECT_EQ(Crc32(Crc32(0, "1234"), "56789"), 0xCBF43926u);
}

/// A recording of format 1, as versions before wrote it.
TEST_F(RecordingFile, ReadsFormatOne) {
  std::string names =
      "sequence,device_time_ns,host_time_ns,valid,buttons,dead_man,emergency_stop,command_echo,"
      "p_x,p_y,p_z,orientation_w,orientation_x,orientation_y,orientation_z,V_DH_0,V_DH_1,V_DH_2,"
      "V_DH_3,V_DH_4,V_DH_5,applied_0,applied_1,applied_2,applied_3,applied_4,applied_5";
  std::string row = "7,0,5,9,0,1,0,0,0.1,0.2,0.3,0,1,0,0";
  for (int i = 0; i < 16; ++i) names += ",q_" + std::to_string(i);
  names +=
      ",gripper,wanted_0,wanted_1,wanted_2,wanted_3,wanted_4,wanted_5,sent_0,sent_1,sent_2,sent_3,"
      "sent_4,sent_5,io,off,stages,energy,late_ns,compute_ns,skipped";
  for (int i = 0; i < 12 + 16 + 13; ++i) row += ",0.5";
  row += ",1,8,9,0.25,1,2,3,0.125";
  std::ofstream(file_) << "# vmech recording 1\n# device arm\n# period 0.001\n# note grasp handle\n"
                       << names << ",off_position\n"
                       << row << "\n";
  const Recording recording = ReadRecording(file_);
  ASSERT_EQ(recording.ticks.size(), 1u);
  const TickRecord& tick = recording.ticks[0];
  EXPECT_EQ(recording.Note("grasp"), "handle");
  EXPECT_EQ(tick.state.sequence, 7u);
  EXPECT_EQ(tick.state.X_DH.R, Matrix3d(Vector3d(1, -1, -1).asDiagonal()));
  EXPECT_EQ(tick.io, IoStatus::kNoNewData);
  EXPECT_EQ(tick.off, ForceOff::kSpeed);
  EXPECT_EQ(tick.stages, kRamped | kSlewed);
  EXPECT_EQ(tick.channels, std::vector<double>{0.125});
  EXPECT_TRUE(recording.complete);
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
    EXPECT_EQ(master.ObservedHand(), nullptr);
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
  master.Activate();
  MasterState state;
  EXPECT_EQ(master.Read(0, &state), IoStatus::kNoNewData);
  ASSERT_NE(master.ObservedHand(), nullptr);
  EXPECT_EQ(master.ObservedHand()->V.angular[1], 1.0 / 3);
}

TEST(ReplayMaster, RefusesAnEmptyRecording) {
  EXPECT_THROW(ReplayMaster(Recording{}), std::invalid_argument);
}

class RecorderTest : public RecordingFile {
 protected:
  RecorderOptions Options(int file) {
    RecorderOptions options;
    options.file = file;
    options.name = file_.string();
    return options;
  }
  int Open() { return open(file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666); }
};

/// As another program sees the file while the session runs: what was taken is there within a
/// second.
TEST_F(RecorderTest, WritesWhileTheSessionRuns) {
  for (const char* name : {"live.csv", "live.mcap"}) {
    file_ = folder_ / name;
    const int file = Open();
    TickRecorder recorder(Sample(0), Options(file));
    for (int k = 0; k < 100; ++k) recorder.Take(SampleTick(k));
    size_t seen = 0;
    for (int wait = 0; wait < 500 && seen < 100; ++wait) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      seen = TextOf(file_).empty() ? 0 : ReadRecording(file_).ticks.size();
    }
    EXPECT_EQ(seen, 100u) << name;
    recorder.Finish();
    EXPECT_EQ(recorder.written(), 100u);
    EXPECT_TRUE(ReadRecording(file_).complete);
    close(file);
  }
}

TEST_F(RecorderTest, AFullDiskIsSaidAtOnce) {
  const int file = open("/dev/full", O_WRONLY);
  std::atomic<bool> said = false;
  RecorderOptions options = Options(file);
  options.on_failure = [&](const std::string&) { said = true; };
  TickRecorder recorder(Sample(0), options);
  for (int wait = 0; wait < 500 && !said; ++wait) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(said);
  recorder.Take(SampleTick(0));
  recorder.Finish();
  EXPECT_NE(recorder.failure().find("No space left"), std::string::npos);
  EXPECT_EQ(recorder.written(), 0u);
  close(file);
}

/// A disk that is full after a while: the file ends with a whole row.
TEST_F(RecorderTest, AFileThatCannotGrowEndsWithAWholeRow) {
  const int file = Open();
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before;
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{1'000'000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  RecorderOptions options = Options(file);
  options.waits = true;
  TickRecorder recorder(Sample(0), options);
  for (int k = 0; k < 5000; ++k) recorder.Take(SampleTick(k));
  recorder.Finish();
  setrlimit(RLIMIT_FSIZE, &before);
  close(file);
  EXPECT_NE(recorder.failure(), "");
  const Recording cut = ReadRecording(file_);
  EXPECT_FALSE(cut.complete);
  EXPECT_EQ(cut.ticks.size(), recorder.written());
  EXPECT_GT(cut.ticks.size(), 100u);
}

/// A listener that holds the thread up until it is let go.
class Slow : public TickListener {
 public:
  void Take(const TickRecord&) override {
    while (!go) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::atomic<bool> go = false;
};

TEST_F(RecorderTest, TheLoopNeverWaitsAndWhatIsLostIsCounted) {
  const int file = Open();
  Slow slow;
  RecorderOptions options = Options(file);
  options.room = 0.1;
  options.listeners = {&slow};
  TickRecorder recorder(Sample(0), options);
  for (int k = 0; k < 1000; ++k) recorder.Take(SampleTick(k));
  slow.go = true;
  recorder.Finish();
  close(file);
  const Recording recording = ReadRecording(file_);
  EXPECT_GT(recorder.lost(), 0u);
  EXPECT_EQ(recording.lost, recorder.lost());
  EXPECT_EQ(recording.ticks.size() + recording.lost, 1000u);
  EXPECT_TRUE(recording.complete);
}

/// Pages of this process [bytes].
std::size_t ResidentMemory() {
  std::size_t all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

/// Kept in memory, these ticks would be 200 MB.
TEST_F(RecorderTest, ALongSessionNeedsNoMoreMemoryThanAShortOne) {
  const int file = open("/dev/null", O_WRONLY);
  RecorderOptions options = Options(file);
  options.waits = true;
  TickRecorder recorder(Sample(0), options);
  const TickRecord tick = SampleTick(0);
  std::size_t early = 0;
  for (int k = 0; k < 200'000; ++k) {
    recorder.Take(tick);
    if (k == 10'000) early = ResidentMemory();
  }
  EXPECT_LT(ResidentMemory(), early + 20'000'000);
  recorder.Finish();
  EXPECT_EQ(recorder.written(), 200'000u);
  EXPECT_EQ(recorder.lost(), 0u);
  close(file);
}

}  // namespace
}  // namespace vmech::recording_test
