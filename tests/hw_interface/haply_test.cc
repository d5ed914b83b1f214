#include "vmech/hw_interface/haply/haply_master.h"

#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "hw_interface/fake_service.h"
#include "vmech/hw_interface/haply/web_socket_frames.h"

namespace vmech::haply_test {
namespace {

using Event = WebSocketReader::Event;
using namespace std::string_literals;

std::vector<std::pair<Event, std::string>> EventsOf(std::string_view bytes, std::size_t piece) {
  WebSocketReader reader;
  std::vector<std::pair<Event, std::string>> events;
  std::string payload;
  while (!bytes.empty()) {
    reader.Append(bytes.substr(0, piece));
    bytes.remove_prefix(std::min(piece, bytes.size()));
    while (true) {
      const Event event = reader.Next(&payload);
      if (event == Event::kNothing) break;
      events.emplace_back(event, payload);
      if (event == Event::kBroken) return events;
    }
  }
  return events;
}

// The examples of RFC 6455, sections 1.3 and 5.7.
TEST(WebSocketFrames, AreThoseOfTheStandard) {
  EXPECT_EQ(WebSocketAcceptKey("dGhlIHNhbXBsZSBub25jZQ=="), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
  EXPECT_EQ(WebSocketFrame(WebSocketOpcode::kText, "Hello", 0x37fa213d),
            "\x81\x85\x37\xfa\x21\x3d\x7f\x9f\x4d\x51\x58"s);
  EXPECT_EQ(EventsOf("\x81\x05Hello", 99), EventsOf("\x01\x03Hel\x80\x02lo", 1));
  EXPECT_EQ(EventsOf("\x89\x05Hello", 3)[0], std::make_pair(Event::kPing, "Hello"s));
}

TEST(WebSocketFrames, LongMessagesComeWhole) {
  for (const std::size_t size : {125, 126, 65535, 65536, 200000}) {
    const std::string text(size, 'x');
    const auto events = EventsOf(ServerFrame(1, text), 1000);
    ASSERT_EQ(events.size(), 1u) << size;
    EXPECT_EQ(events[0].second, text);
    // A frame of the client is that of a server but for the mask.
    EXPECT_EQ(WebSocketFrame(WebSocketOpcode::kText, text, 0).size(),
              ServerFrame(1, text).size() + 4);
  }
}

TEST(WebSocketFrames, PingsAndPongsMayComeBetweenFragments) {
  const std::string bytes = ServerFrame(1, "a", false) + ServerFrame(10, "pong") +
                            ServerFrame(9, "ping") + ServerFrame(0, "b", false) +
                            ServerFrame(0, "c");
  const auto events = EventsOf(bytes, 2);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0], std::make_pair(Event::kPing, "ping"s));
  EXPECT_EQ(events[1], std::make_pair(Event::kText, "abc"s));
}

TEST(WebSocketFrames, WhatBreaksTheProtocolIsNamed) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"\xc1\x01x", "reserved"},
      {"\x81\x81\x01\x02\x03\x04x", "masked"},
      {ServerFrame(9, std::string(126, 'x')), "control"},
      {ServerFrame(8, "", false), "control"},
      {ServerFrame(0, "x"), "out of its place"},
      {ServerFrame(1, "x", false) + ServerFrame(1, "y"), "out of its place"},
      {ServerFrame(2, "x"), "not text"},
      {ServerFrame(11, "x"), "unknown kind"},
      {"\x81\x7f\xff\xff\xff\xff\xff\xff\xff\xff", "18446744073709551615 bytes"},
      {ServerFrame(1, std::string(700000, 'x'), false) + ServerFrame(0, std::string(700000, 'x')),
       "a message of more"}};
  for (const auto& [bytes, problem] : cases) {
    WebSocketReader reader;
    reader.Append(bytes);
    std::string payload;
    EXPECT_EQ(reader.Next(&payload), Event::kBroken) << problem;
    EXPECT_NE(reader.problem().find(problem), std::string::npos) << reader.problem();
    reader.Append(ServerFrame(1, "x"));
    EXPECT_EQ(reader.Next(&payload), Event::kBroken);  // for good
  }
}

TEST(HaplyWire, ForceGoesOutInTheWordsOfTheVersion) {
  const HaplyDevice older = *ReadHaplyDevice(R"({"inverse3":[{"device_id":"049D"}]})");
  EXPECT_EQ(
      HaplyForceCommand(older, Vector3d(1, -2, 0.5)),
      R"({"inverse3":[{"commands":{"set_cursor_force":{"values":{"x":1.0,"y":-2.0,"z":0.5}}},)"
      R"("device_id":"049D"}]})");
  const HaplyDevice newer =
      *ReadHaplyDevice(R"({"session_id":7,"inverse3":[{"device_id":"049D"}]})");
  EXPECT_NE(HaplyForceCommand(newer, Vector3d::Zero()).find(R"("vector":{"x":0.0)"),
            std::string::npos);
}

TEST(HaplyWire, StateOfTheDeviceAndItsGripIsRead) {
  const auto sample = ReadHaplyState(
      R"({"inverse3":[{"device_id":"A"},{"device_id":"B","state":{
          "cursor_position":{"x":0.1,"y":-0.2,"z":0.3},"cursor_velocity":{"x":1,"y":2,"z":3},
          "current_cursor_force":{"x":4,"y":5,"z":6}}}],
          "wireless_verse_grip":[{"state":{"orientation":{"w":0.6,"x":0,"y":0,"z":0.8},
          "buttons":{"a":true,"b":false,"c":true}}}]})",
      "B");
  ASSERT_TRUE(sample);
  EXPECT_EQ(*sample->position, Vector3d(0.1, -0.2, 0.3));
  EXPECT_EQ(*sample->velocity, Vector3d(1, 2, 3));
  EXPECT_EQ(*sample->force, Vector3d(4, 5, 6));
  EXPECT_EQ(sample->orientation->z(), 0.8);
  EXPECT_EQ(sample->buttons, 0b101u);
}

TEST(HaplyWire, WhatIsNoStateGivesNone) {
  for (const char* text :
       {"", "{", "[]", "7", "\"inverse3\"", "{}", R"({"inverse3":7})", R"({"inverse3":[]})",
        R"({"inverse3":[7,null,{"device_id":3},{"device_id":"X","state":{}}]})"}) {
    EXPECT_FALSE(ReadHaplyState(text, "B")) << text;
  }
  const auto sample = ReadHaplyState(
      R"({"inverse3":[{"device_id":"B","state":{"cursor_position":{"x":"1","y":2,"z":3},
          "cursor_velocity":{"x":1,"y":2},"current_cursor_force":null}}],
          "verse_grip":[{"state":{"orientation":{"w":0,"x":0,"y":0,"z":0},"button":true}}]})",
      "B");
  ASSERT_TRUE(sample);
  EXPECT_FALSE(sample->position || sample->velocity || sample->force || sample->orientation);
  EXPECT_EQ(sample->buttons, 1u);
  EXPECT_THROW((void)ReadHaplyDevice("nonsense"), std::runtime_error);
  EXPECT_FALSE(ReadHaplyDevice(R"({"inverse3":[]})"));
}

constexpr std::string_view kInventory =
    R"({"session_id":1,"inverse3":[{"device_id":"B","status":{"calibrated":true},"state":{
        "cursor_position":{"x":0,"y":0,"z":0},"current_cursor_force":{"x":0,"y":0,"z":0}}}]})";

std::string StateAt(double x) {
  return ServerFrame(1, R"({"inverse3":[{"device_id":"B","state":{"cursor_position":{"x":)" +
                            std::to_string(x) +
                            R"(,"y":0,"z":0},"current_cursor_force":{"x":1,"y":0,"z":0}}}]})");
}

/// A master at a fake service, and a loop that reads and writes until something holds.
class Haply : public testing::Test {
 protected:
  void Start(FakeService::Answer answer) {
    service_ = std::make_unique<FakeService>(std::string(kInventory), std::move(answer));
    HaplyOptions options;
    options.port = service_->port();
    master_ = std::make_unique<HaplyMaster>(options);
    master_->Configure();
    master_->Activate();
  }

  void Tick(double force) {
    now_ += 1'000'000;
    status_ = master_->Read(now_, &state_);
    MasterCommand command;
    command.mode = CommandMode::kWrench;
    command.F_Ho_D[0] = force;
    command.valid_until_ns = now_ + 5'000'000;
    (void)master_->Write(command);
  }

  template <typename Holds>
  bool TickUntil(Holds holds, double force = 1) {
    for (int k = 0; k < 10'000; ++k) {
      Tick(force);
      if (holds()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  template <typename Holds>
  static bool WaitUntil(Holds holds) {
    for (int k = 0; k < 10'000 && !holds(); ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return holds();
  }

  std::unique_ptr<FakeService> service_;
  std::unique_ptr<HaplyMaster> master_;
  MasterState state_;
  IoStatus status_ = IoStatus::kOk;
  std::int64_t now_ = 0;
};

TEST_F(Haply, ForceArrivesAndMotionComesBack) {
  Start([](int k, const std::string&) { return StateAt(1e-3 * k); });
  EXPECT_EQ(master_->info().name, "Haply Inverse3 B");
  EXPECT_EQ(master_->info().angular.peak, 0);
  ASSERT_TRUE(TickUntil([&] { return state_.X_DH.p.x() > 0.02; }));
  EXPECT_TRUE(state_.valid & kSensesPose);
  EXPECT_FALSE(state_.valid & kSensesTwist);  // this one tells none
  EXPECT_EQ(state_.applied_F_Ho_D[0], 1);
  EXPECT_GT(state_.sequence, 0u);
  EXPECT_TRUE(state_.dead_man);
  EXPECT_NE(service_->last().find(R"("vector":{"x":1.0,)"), std::string::npos) << service_->last();
}

TEST_F(Haply, ForceEndsWhenTheLoopStopsWriting) {
  Start([](int, const std::string&) { return StateAt(0); });
  const auto wants = [&](const char* x) {
    return service_->last().find(R"("vector":{"x":)"s + x) != std::string::npos;
  };
  ASSERT_TRUE(TickUntil([&] { return wants("1.0"); }));
  EXPECT_TRUE(WaitUntil([&] { return wants("0.0"); }));
}

TEST_F(Haply, LinkIsLostWhileTheServiceIsSilent) {
  std::atomic<bool> silent = false;
  Start([&](int, const std::string&) { return silent ? "" : StateAt(0.1); });
  ASSERT_TRUE(TickUntil([&] { return status_ == IoStatus::kOk; }));
  silent = true;
  ASSERT_TRUE(TickUntil([&] { return status_ == IoStatus::kLinkLost; }));
  EXPECT_EQ(state_.valid, 0u);
}

TEST_F(Haply, LinkThatWasCutStaysLost) {
  Start([](int k, const std::string&) { return k < 20 ? StateAt(0) : FakeService::kHangUp; });
  ASSERT_TRUE(TickUntil([&] { return status_ == IoStatus::kOk; }));
  ASSERT_TRUE(TickUntil([&] { return status_ == IoStatus::kLinkLost; }));
  EXPECT_EQ(service_->connections(), 1);
  for (int k = 0; k < 20; ++k) Tick(1);
  EXPECT_EQ(status_, IoStatus::kLinkLost);
  EXPECT_EQ(service_->connections(), 1);
}

TEST_F(Haply, NonsenseIsCountedAndNoSample) {
  Start([](int k, const std::string&) {
    return k % 2 == 0 ? ServerFrame(1, "nonsense") : StateAt(1e-3 * k);
  });
  ASSERT_TRUE(TickUntil([&] { return state_.X_DH.p.x() > 0.01; }));
  EXPECT_GT(master_->malformed(), 3u);
}

TEST_F(Haply, PingIsAnsweredAndTheConversationGoesOn) {
  Start([](int k, const std::string&) {
    return ServerFrame(9, "are you there") + StateAt(1e-3 * k);
  });
  ASSERT_TRUE(TickUntil([&] { return state_.X_DH.p.x() > 0.01; }));
  EXPECT_GT(service_->pongs(), 3);
}

TEST_F(Haply, FrameAgainstTheProtocolEndsIt) {
  Start([](int k, const std::string&) { return k < 10 ? StateAt(0) : ServerFrame(2, "binary"); });
  EXPECT_TRUE(TickUntil([&] { return status_ == IoStatus::kLinkLost; }));
}

std::string ErrorAt(int port) {
  HaplyOptions options;
  options.port = port;
  options.connect_timeout = 0.3;
  try {
    HaplyMaster(options).Configure();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(HaplyMaster, SaysWhyThereIsNoDevice) {
  const auto says = [](const std::string& inventory, const char* reason) {
    FakeService service(inventory, [](int, const std::string&) { return ""s; });
    const std::string error = ErrorAt(service.port());
    EXPECT_NE(error.find(reason), std::string::npos) << error;
    EXPECT_NE(error.find("Inverse Service"), std::string::npos) << error;
  };
  says(R"({"inverse3":[]})", "knows of no Inverse3");
  says("hello", "no list of devices");
  says(R"({"inverse3":[{"device_id":"B","status":{"calibrated":false}}]})", "not calibrated");
  says("", "says nothing");
  EXPECT_NE(ErrorAt(1).find("127.0.0.1:1"), std::string::npos);
  HaplyOptions options;
  options.port = 70000;
  EXPECT_THROW(HaplyMaster{options}, std::invalid_argument);
}

}  // namespace
}  // namespace vmech::haply_test
