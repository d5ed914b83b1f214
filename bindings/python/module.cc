// The raw layer under the package vmech (vmech/__init__.py), which documents it: classes without a
// constructor, functions with every argument.

#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "convert.h"
#include "vmech/apps/compare/journal.h"
#include "vmech/apps/compare/run_comparison.h"
#include "vmech/apps/compare/suite_reader.h"
#include "vmech/apps/drawing/mechanism_drawing.h"
#include "vmech/bindings/shared/computed.h"
#include "vmech/bindings/shared/parametric.h"
#include "vmech/bindings/shared/posed_mechanism.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/file_errors.h"
#include "vmech/mechanisms/files/writer.h"
#include "vmech/mechanisms/validity.h"
#include "vmech/studies/study_reader.h"

namespace vmech::python {

void RequireCount(const char* name, const Numbers& numbers, py::ssize_t count) {
  if (numbers.size() == count) return;
  throw std::invalid_argument(std::string(name) + " has " + std::to_string(numbers.size()) +
                              " numbers, must have " + std::to_string(count));
}

Posed PoseOf(const Numbers& position, const std::optional<Numbers>& rotation) {
  Posed X;
  X.p = VectorOf("position", position);
  if (!rotation) return X;
  RequireCount("rotation", *rotation, 9);
  X.R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotation->data());
  return X;
}

py::object ViewOf(const NumberArray& numbers, const py::object& owner) {
  if (numbers.data == nullptr) return py::none();
  const auto rank = static_cast<ptrdiff_t>(numbers.rank);
  const std::vector<py::ssize_t> shape(numbers.shape.begin(), numbers.shape.begin() + rank);
  const std::vector<py::ssize_t> strides(numbers.strides.begin(), numbers.strides.begin() + rank);
  py::array view(py::dtype::of<double>(), shape, strides, numbers.data, owner);
  py::detail::array_proxy(view.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return view;
}

namespace {

template <typename List>
std::vector<std::string> Names(const List& list) {
  std::vector<std::string> names;
  for (const auto& item : list) names.push_back(item.name);
  return names;
}

/// Python's own answer to an exception of the library, with what it knows.
void RegisterErrors(py::module_* module) {
  static py::exception<FileErrors> file_errors(*module, "FileErrors", PyExc_ValueError);
  static py::exception<std::runtime_error> no_solution(*module, "NoSolution", PyExc_RuntimeError);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const FileErrors& error) {
      py::list errors;
      for (const FileError& e : error.errors()) {
        errors.append(py::make_tuple(e.file, e.line, e.column, e.path, e.message));
      }
      const py::object value = py::handle(file_errors.ptr())(error.what());
      value.attr("errors") = errors;
      PyErr_SetObject(file_errors.ptr(), value.ptr());
    } catch (const py::builtin_exception&) {
      throw;  // pybind11's own, for it to translate
    } catch (const std::runtime_error& error) {
      PyErr_SetString(no_solution.ptr(), error.what());
    }
  });
}

/// What Python says now and then while the interpreter does other things: Ctrl-C and a callback.
class Progress {
 public:
  explicit Progress(py::object callback) : callback_(std::move(callback)) {}

  bool GoesOn(size_t poses) noexcept {
    const py::gil_scoped_acquire held;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      stopped_ = !callback_.is_none() && !callback_(poses).cast<bool>();
    } catch (...) {
      error_ = std::current_exception();
    }
    return !stopped_ && !error_;
  }
  /// Goes on with what Python raised.
  void Rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  py::object callback_;
  std::exception_ptr error_;
  bool stopped_ = false;
};

std::shared_ptr<Computed> Run(const StudyFile& file, int threads, const py::object& callback) {
  Progress progress(callback);
  LoadStudyOptions options;
  options.threads = threads;
  options.progress = [&](size_t poses) { return progress.GoesOn(poses); };
  std::shared_ptr<Computed> computed;
  std::exception_ptr error;
  {
    const py::gil_scoped_release released;
    try {
      computed = std::make_shared<Computed>(RunStudy(file, options));
    } catch (...) {
      error = std::current_exception();
    }
  }
  progress.Rethrow();
  if (error) std::rethrow_exception(error);
  return computed;
}

/// A study of a mechanism in memory. Drives: (joint, freedom, start, speed, acceleration, times,
/// values); loads: (link, point, wrench, in the link's axes).
using GivenDrive =
    std::tuple<int, int, double, double, double, std::vector<double>, std::vector<double>>;
using GivenLoad = std::tuple<int, Numbers, Numbers, bool>;

StudyFile StudyOf(const Mechanism& mechanism, const std::vector<GivenDrive>& drives,
                  const std::vector<double>& times, double cycle,
                  const std::vector<GivenLoad>& loads) {
  StudyFile file;
  file.study.mechanism = mechanism;
  file.study.times = times;
  file.study.cycle = cycle;
  for (const auto& [joint, freedom, start, speed, acceleration, at, values] : drives) {
    file.study.drives.push_back({joint, freedom,
                                 at.empty() ? MotionLaw::Uniform(start, speed, acceleration)
                                            : MotionLaw::Table(at, values)});
  }
  for (const auto& [link, point, wrench, in_link_axes] : loads) {
    const Vector6d w = Vector6Of("wrench", wrench);
    ExternalLoad load;
    load.link = link;
    load.p_L = VectorOf("point", point);
    load.axes = in_link_axes ? ExternalLoad::Axes::kLink : ExternalLoad::Axes::kWorld;
    load.at = {0};
    load.wrenches = {{w.head<3>(), w.tail<3>()}};
    file.study.external.push_back(std::move(load));
  }
  return file;
}

std::shared_ptr<Computed> Ik(const Mechanism& mechanism, int grasp, const Numbers& position,
                             const std::optional<Numbers>& rotation, const Numbers& stiffness,
                             bool limits, const std::string& solver) {
  const std::optional<Backend> backend = BackendFromName(solver);
  if (!backend) throw std::invalid_argument("solver: there is no " + Quoted(solver));
  const HandQuestion question{grasp, PoseOf(position, rotation), Vector6Of("stiffness", stiffness),
                              limits, *backend};
  const py::gil_scoped_release released;
  return std::make_shared<Computed>(FindNearestPose(mechanism, question));
}

std::shared_ptr<Computed> Modes(const Mechanism& mechanism, const std::vector<int>& held, int grasp,
                                const Numbers& position, const std::optional<Numbers>& rotation,
                                bool limits, int max_starts, int patience, std::uint64_t seed) {
  const ModesQuestion question{held,     grasp, PoseOf(position, rotation), limits, max_starts,
                               patience, seed};
  const py::gil_scoped_release released;
  return std::make_shared<Computed>(FindAllPoses(mechanism, question));
}

/// As its loops close, or as it is drawn where they do not.
std::string Svg(const Mechanism& mechanism) {
  const py::gil_scoped_release released;
  RequireValid(mechanism);
  return DrawMechanism(BuildKinematicTree(AssembleMechanism(mechanism).mechanism));
}

py::list BearingsOf(const Computed& computed) {
  py::list all;
  for (const BearingOutcome& outcome : computed.outcome().bearings) {
    const JointBearings& joint = outcome.bearings;
    py::list positions;
    for (const BearingSelection& selection : joint.selections) {
      const Candidate* best = selection.best();
      if (best == nullptr || !best->rating) continue;
      positions.append(py::make_tuple(best->bearing.designation, best->rating->modified_life_hours,
                                      best->rating->static_safety));
    }
    all.append(py::make_tuple(outcome.joint, joint.met(),
                              joint.certainty == LoadCertainty::kCertain, joint.system_life_hours,
                              positions, joint.BriefReport()));
  }
  return all;
}

/// (status, message, events) of a simulation; None of a study of loads.
py::object SimulationOf(const Computed& computed) {
  if (!computed.outcome().simulation) return py::none();
  const SimulationResult& simulation = *computed.outcome().simulation;
  py::list events;
  for (const SimulationEvent& event : simulation.events) {
    events.append(py::make_tuple(event.time, std::string(NameOf(event.kind)), event.at.joint,
                                 event.at.freedom, event.value, event.rate));
  }
  return py::make_tuple(std::string(NameOf(simulation.status)), simulation.message, events);
}

py::list CertaintyOf(const Computed& computed) {
  py::list joints;
  for (const JointCertainty& joint : computed.certainty()) {
    py::list verdicts;
    for (const Certainty certainty : joint) verdicts.append(static_cast<int>(certainty));
    joints.append(verdicts);
  }
  return joints;
}

/// Every problem of a suite by these solvers in this process, (mechanism, targets, index, solver,
/// verdict, branch, iterations, seconds, e1 [m], e1 [rad], e2, message). `folder`: an empty one.
py::list Compare(const std::filesystem::path& path, const std::vector<std::string>& names,
                 const std::filesystem::path& folder, const py::object& callback) {
  std::vector<SolverEntry> solvers;
  for (const std::string& name : names) {
    const std::optional<SolverEntry> solver = ContestantFromName(name);
    if (!solver) throw std::invalid_argument("solvers: there is no " + Quoted(name));
    solvers.push_back(*solver);
  }
  if (names.empty()) solvers = AllContestants();
  const Suite suite = ReadSuite(path);
  Journal journal(folder, {suite.digest, 0, VMECH_VERSION}, suite);
  Progress progress(callback);
  const Spread here = [&](const std::vector<std::string>& tasks, const Coordinator& coordinator) {
    const Work work = ComparisonWork(suite);
    for (size_t i = 0; i < tasks.size() && progress.GoesOn(i); ++i) {
      work(tasks[i], [&](const std::string& answer) { coordinator.answer(i, answer); });
    }
  };
  std::vector<Result> results;
  {
    const py::gil_scoped_release released;
    results = RunComparison(suite, solvers, here, &journal, [](size_t) {});
  }
  progress.Rethrow();
  py::list rows;
  for (const Result& r : results) {
    rows.append(py::make_tuple(suite.mechanisms[r.problem.mechanism].name,
                               suite.blocks[r.problem.block].name, r.problem.index,
                               std::string(r.solver.name()), std::string(NameOf(r.verdict)),
                               std::string(NameOf(r.branch)), r.iterations, r.time, r.e1_position,
                               r.e1_rotation, r.e2, r.message));
  }
  return rows;
}

using GivenParameter = std::tuple<std::string, double, std::string>;
using MechanismAndParameters = std::pair<std::shared_ptr<Mechanism>, std::vector<GivenParameter>>;

std::vector<std::string> JointTypes(const Mechanism& mechanism) {
  std::vector<std::string> types;
  for (const Joint& joint : mechanism.joints) types.emplace_back(NameOf(joint.type));
  return types;
}

/// (name, value, unit) of each.
std::vector<GivenParameter> Stated(const std::vector<StatedParameter>& parameters) {
  std::vector<GivenParameter> stated;
  for (const StatedParameter& p : parameters) stated.push_back({p.name, p.figure, p.unit});
  return stated;
}

/// A mechanism and its parameters, read with "crank=60" or the like.
MechanismAndParameters ParseMechanismText(const std::string& text, const std::string& name,
                                          const std::vector<std::string>& settings) {
  ParametricMechanism read = ReadParametric(text, name, SettingsOf(settings));
  return {std::make_shared<Mechanism>(std::move(read.mechanism)), Stated(read.parameters)};
}
MechanismAndParameters ReadMechanismFile(const std::filesystem::path& path,
                                         const std::vector<std::string>& settings) {
  return ParseMechanismText(ReadTextFile(path), path.string(), settings);
}

void BindMechanism(py::module_* module) {
  py::class_<Mechanism, std::shared_ptr<Mechanism>>(*module, "Mechanism")
      .def_static("read", &ReadMechanismFile)
      .def_static("parse", &ParseMechanismText)
      .def("write", [](const Mechanism& m) { return WriteMechanism(m); })
      .def("svg", &Svg)
      .def("ik", &Ik)
      .def("modes", &Modes)
      .def("freedoms", &NamesOfAllFreedoms)
      .def("joint_types", &JointTypes)
      .def("start", &StartOfFreedoms)
      .def_readonly("name", &Mechanism::name)
      .def_property_readonly("gravity",
                             [](const Mechanism& m) {
                               return std::vector<double>(m.gravity_W.begin(), m.gravity_W.end());
                             })
      .def("masses",
           [](const Mechanism& m) {
             std::vector<std::pair<double, std::vector<double>>> masses;
             for (const Link& link : m.links) {
               const Vector3d& p = link.mass_properties.p_LoLcm;
               masses.push_back({link.mass_properties.mass, {p.begin(), p.end()}});
             }
             return masses;
           })
      .def("links", [](const Mechanism& m) { return Names(m.links); })
      .def("joints", [](const Mechanism& m) { return Names(m.joints); })
      .def("grasps", [](const Mechanism& m) { return Names(m.grasps); });
}

void BindStudy(py::module_* module) {
  py::class_<StudyFile, std::shared_ptr<StudyFile>>(*module, "Study")
      .def_static("read",
                  [](const std::filesystem::path& path, const std::vector<std::string>& settings) {
                    return ReadStudy(path, SettingsOf(settings));
                  })
      .def("parameters", [](const StudyFile& f) { return Stated(f.parameters); })
      .def_static("of", &StudyOf)
      .def("run", &Run)
      .def_readonly("name", &StudyFile::name)
      .def_property_readonly("simulates",
                             [](const StudyFile& f) { return f.simulation.has_value(); })
      .def("mechanism", [](const StudyFile& f) { return f.study.mechanism; })
      .def("drives", [](const StudyFile& f) {
        std::vector<std::pair<int, int>> drives;
        for (const JointDrive& drive : f.study.drives)
          drives.push_back({drive.joint, drive.freedom});
        return drives;
      });
}

void BindComputed(py::module_* module) {
  py::class_<Computed, std::shared_ptr<Computed>>(*module, "Computed")
      .def("array",
           [](const py::object& self, const std::string& name) {
             const auto& computed = self.cast<const Computed&>();
             for (const ArrayKindName& known : kQuantities) {
               if (known.name == name) return ViewOf(computed.Array(known.quantity), self);
             }
             throw std::invalid_argument("there is no array of the name " + Quoted(name));
           })
      .def("poses", &Computed::pose_count)
      .def("certainty", &CertaintyOf)
      .def("bearings", &BearingsOf)
      .def("simulation", &SimulationOf)
      .def("report", [](const Computed& c) { return c.outcome().loads.BriefReport(); })
      .def_property_readonly("warnings", &Computed::warnings);
}

}  // namespace

PYBIND11_MODULE(_vmech, module) {  // NOLINT
  module.attr("version") = VMECH_VERSION;
  RegisterErrors(&module);
  BindMechanism(&module);
  BindStudy(&module);
  BindComputed(&module);
  BindHaptic(&module);
  module.def("compare", &Compare);
}

}  // namespace vmech::python
