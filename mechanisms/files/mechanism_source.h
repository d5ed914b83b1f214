#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/mechanisms/expressions/parameter_table.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/units.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// The version of the file format that this library reads: the value of the key `vmech`.
constexpr std::string_view kMechanismFormat = "1.0";

/// A parameter and its value, for what is said about them.
struct StatedParameter {
  std::string name;   ///< as it is declared
  double figure = 0;  ///< its value in `unit`
  std::string unit;   ///< empty for a number
};

/// A mechanism file that is parsed once and read as often as its parameters change, with the files
/// that it uses.
class MechanismSource {
 public:
  /// `name` stands for the file in messages; the files that it uses are named relative to its
  /// folder. @throws FileErrors if the text is no document.
  MechanismSource(std::string_view text, const std::string& name);
  MechanismSource(const MechanismSource&) = delete;
  MechanismSource& operator=(const MechanismSource&) = delete;
  ~MechanismSource();

  const std::string& name() const { return document_.name(); }  ///< as messages name it
  const CountingUnits& units() const { return scope_.units; }   ///< of the file's bare numbers
  /// The parameters; those that others declare here are seen by the expressions of the file.
  ParameterTable& parameters() { return table_; }
  const ParameterTable& parameters() const { return table_; }  ///< the same, to read
  /// What the parameters are, as of the last reading.
  const NamedQuantities<double>& values() const { return scope_.values; }
  std::vector<StatedParameter> stated() const;  ///< with their values of the last reading
  /// The places where parameters stand.
  const std::vector<ParameterUse>& uses() const { return document_.uses(); }

  /// The mechanism for the parameters as they are declared and set.
  /// @throws FileErrors with everything that is wrong: what, where, and what to do.
  Mechanism Read();

  /// The file itself and those that it uses, each once, as they were read.
  struct File {
    std::filesystem::path path;  ///< absolute
    std::string text;            ///< its bytes
  };
  std::vector<File> files() const;  ///< the first is the one that was asked for

 private:
  MechanismSource(std::string_view text, const std::string& name,
                  std::vector<std::filesystem::path> users);
  void Resolve();
  Mechanism ReadOnce();
  void ReadParts(const Units& units, Mechanism* mechanism);
  void ReadUses(const Units& units, Mechanism* mechanism);
  void ReadUse(const Node& node, const Units& units, Mechanism* mechanism);
  MechanismSource* SourceOf(const Node& node);
  void FixParameters(const Node& block, MechanismSource* used);
  void CheckWhole(const Mechanism& mechanism);

  std::string text_;
  Document document_;
  Units units_;
  ExpressionScope scope_;
  ParameterTable table_;
  std::vector<std::filesystem::path> users_;                      ///< the file itself last
  std::map<std::string, std::unique_ptr<MechanismSource>> used_;  ///< by the name of the use
  size_t errors_of_text_ = 0;                                     ///< whatever its parameters are
  std::vector<Node> link_nodes_;  ///< for each link of the mechanism the node that brought it
};

}  // namespace vmech
