#include "vmech/hw_interface/masters/plugin_master.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace vmech::plugin_master_test {
namespace {

std::string ErrorOf(const std::string& library, const std::string& parameters) {
  try {
    PluginMaster{library, parameters};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(PluginMaster, CarriesCommandsThereAndStatesBack) {
  PluginMaster master(VMECH_EXAMPLE_PLUGIN, "");
  master.Configure();
  EXPECT_EQ(master.info().name, "example");
  EXPECT_EQ(master.info().period, 2e-3);
  EXPECT_EQ(master.info().linear.damping, 3);
  master.Activate();
  MasterCommand command;
  command.mode = CommandMode::kWrench;
  command.F_Ho_D.head<3>() = Vector3d(1, 2, 3);
  ASSERT_EQ(master.Write(command), IoStatus::kOk);
  MasterState state;
  ASSERT_EQ(master.Read(5, &state), IoStatus::kOk);
  EXPECT_EQ(state.X_DH.p, Vector3d(1, 2, 3));
  EXPECT_EQ(state.X_DH.R * Vector3d::UnitX(), Vector3d(Vector3d::UnitY()));
  EXPECT_TRUE(state.dead_man);  // it has no such switch
}

TEST(PluginMaster, RecoversFromTheDevicesFault) {
  PluginMaster master(VMECH_EXAMPLE_PLUGIN, "");
  master.Configure();
  master.Activate();
  MasterCommand command;
  command.mode = CommandMode::kWrench;
  command.F_Ho_D[0] = 101;
  ASSERT_EQ(master.Write(command), IoStatus::kOk);
  MasterState state;
  EXPECT_EQ(master.Read(5, &state), IoStatus::kDeviceFault);
  EXPECT_EQ(master.lifecycle(), Lifecycle::kFault);
  master.Recover();
  EXPECT_EQ(master.Read(6, &state), IoStatus::kOk);
}

TEST(PluginMaster, SaysWhyAPluginCannotBeUsed) {
  const std::string library = VMECH_EXAMPLE_PLUGIN;
  EXPECT_EQ(ErrorOf(library, "broken"),
            "plug-in " + library + ": refuses 'broken': no such serial number");
  EXPECT_NE(ErrorOf(library, "old").find("made for version 0"), std::string::npos);
  EXPECT_NE(ErrorOf(library, "gaps").find("has gaps"), std::string::npos);
  EXPECT_NE(ErrorOf("/nowhere.so", "").find("/nowhere.so"), std::string::npos);
}

}  // namespace
}  // namespace vmech::plugin_master_test
