#include "vmech/apps/compare/process_pool.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <map>
#include <stdexcept>

namespace vmech {
namespace {

std::vector<std::string> Tasks(int count) {
  std::vector<std::string> tasks;
  for (int i = 0; i < count; ++i) tasks.push_back(std::to_string(i));
  return tasks;
}

TEST(RunInProcesses, BringsEveryAnswerOfEveryTask) {
  std::map<size_t, std::string> answers;
  const Coordinator coordinator{
      [&](size_t index, const std::string& answer) { answers[index] += answer + ";"; },
      [](size_t, const std::string& reason) -> std::optional<std::string> {
        ADD_FAILURE() << reason;
        return {};
      }};
  const Work work = [](const std::string& task, const Emit& emit) {
    emit(task);
    emit("twice " + std::to_string(2 * std::stoi(task)));
  };
  RunInProcesses(3, Tasks(20), work, coordinator);
  ASSERT_EQ(answers.size(), 20u);
  EXPECT_EQ(answers[7], "7;twice 14;");
}

TEST(RunInProcesses, GoesOnWhereAWorkerIsKilled) {
  std::map<size_t, std::string> answers;
  int lost = 0;
  const Coordinator coordinator{
      [&](size_t index, const std::string& answer) { answers[index] = answer; },
      [&](size_t, const std::string& reason) -> std::optional<std::string> {
        EXPECT_NE(reason.find("signal 9"), std::string::npos) << reason;
        ++lost;
        return "again";
      }};
  const Work work = [](const std::string& task, const Emit& emit) {
    if (task == "3" || task == "5") raise(SIGKILL);
    emit(task);
  };
  RunInProcesses(2, Tasks(8), work, coordinator);
  EXPECT_EQ(lost, 2);
  EXPECT_EQ(answers.size(), 8u);
  EXPECT_EQ(answers[3], "again");
  EXPECT_EQ(answers[4], "4");
}

TEST(RunInProcesses, TellsWhatAWorkerThrew) {
  std::string told;
  const Coordinator coordinator{
      [](size_t, const std::string&) {},
      [&](size_t, const std::string& reason) -> std::optional<std::string> {
        told = reason;
        return {};
      }};
  RunInProcesses(
      1, Tasks(1), [](const std::string&, const Emit&) { throw std::runtime_error("no way"); },
      coordinator);
  EXPECT_EQ(told, "no way");
}

TEST(RunInProcesses, PassesOnWhatTheForemanThrows) {
  const Coordinator coordinator{
      [](size_t, const std::string&) { throw std::runtime_error("the disk is full"); },
      [](size_t, const std::string&) -> std::optional<std::string> { return {}; }};
  const Work work = [](const std::string& task, const Emit& emit) { emit(task); };
  EXPECT_THROW(RunInProcesses(2, Tasks(5), work, coordinator), std::runtime_error);
}

}  // namespace
}  // namespace vmech
