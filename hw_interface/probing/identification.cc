#include "vmech/hw_interface/probing/identification.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <vector>

namespace vmech {
namespace {

constexpr int kUnknowns = 5;  // mass, damping, dry friction, spring, constant

/// A recording on the grid of the device's periods.
struct Series {
  double period = 0;
  Eigen::Matrix3Xd p, F;  // positions; forces sent at these samples
  VectorXd axis, blow;
};

Series SeriesOf(const Recording& recording) {
  std::vector<const TickRecord*> fresh;
  for (const TickRecord& tick : recording.ticks) {
    const bool news = fresh.empty() || tick.state.sequence > fresh.back()->state.sequence;
    if (tick.io == IoStatus::kOk && news) fresh.push_back(&tick);
  }
  if (fresh.size() < 1000) {
    throw std::runtime_error("too few samples of the device to tell anything by");
  }
  const std::uint64_t first = fresh.front()->state.sequence;
  const auto size = static_cast<Eigen::Index>(fresh.back()->state.sequence - first + 1);
  if (size > 4 * static_cast<Eigen::Index>(fresh.size())) {
    throw std::runtime_error("most samples of the device are missing");
  }
  Series series{recording.period, Eigen::Matrix3Xd(3, size), Eigen::Matrix3Xd(3, size),
                VectorXd(size), VectorXd(size)};
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    const TickRecord &now = *fresh[i], &next = *fresh[std::min(i + 1, fresh.size() - 1)];
    const auto from = static_cast<Eigen::Index>(now.state.sequence - first);
    const auto to = std::max(from + 1, static_cast<Eigen::Index>(next.state.sequence - first));
    for (Eigen::Index k = from; k < to; ++k) {  // straight over what is missing
      const double share = static_cast<double>(k - from) / static_cast<double>(to - from);
      series.p.col(k) = now.state.X_DH.p + share * (next.state.X_DH.p - now.state.X_DH.p);
      series.F.col(k) = now.sent_F_Ho_D.head<3>();
      series.axis[k] = now.channels[0];
      series.blow[k] = now.channels[1];
    }
  }
  return series;
}

/// w(s) = (4 s (1 - s))^4, s in [0, 1], and its derivatives by s.
struct Weight {
  double w, first, second;
};
Weight WeightAt(double s) {
  const double u = 4 * s * (1 - s), du = 4 - 8 * s;
  return {std::pow(u, 4), 4 * std::pow(u, 3) * du, 12 * u * u * du * du - 32 * std::pow(u, 3)};
}

/// Which way the handle goes, -1 to 1: without a step where it turns.
double Direction(const Series& series, int axis, Eigen::Index k) {
  constexpr Eigen::Index kReach = 4;
  constexpr double kSlow = 2e-3;  // [m/s]
  const Eigen::Index from = std::max<Eigen::Index>(0, k - kReach);
  const Eigen::Index to = std::min(series.p.cols() - 1, k + kReach);
  const double v = (series.p(axis, to) - series.p(axis, from)) /
                   (static_cast<double>(to - from) * series.period);
  return std::clamp(v / kSlow, -1.0, 1.0);
}

/// The weighted equation of motion over a window: what multiplies the unknowns, and the force.
struct Row {
  Eigen::Matrix<double, 1, kUnknowns> terms = Eigen::Matrix<double, 1, kUnknowns>::Zero();
  double force = 0;
  double still = 0;  ///< share of the window in which the handle stands: dry friction is less there
};
Row RowOf(const Series& series, int axis, Eigen::Index from, Eigen::Index size,
          Eigen::Index delay) {
  Row row;
  const double T = series.period, length = static_cast<double>(size) * T;
  const double middle = series.p.row(axis).segment(from, size).mean();
  for (Eigen::Index k = 0; k < size; ++k) {
    const auto n = static_cast<double>(size);
    const Weight at = WeightAt(static_cast<double>(k) / n);
    const double x = series.p(axis, from + k) - middle;
    row.terms[0] += T * at.second / (length * length) * x;
    row.terms[1] -= T * at.first / length * x;
    const double direction = Direction(series, axis, from + k);
    row.terms[2] += T * at.w * direction;
    row.still += T * at.w * (1 - std::abs(direction));
    row.terms[3] += T * at.w * x;
    row.terms[4] += T * at.w;
    // A force holds until the next sample.
    const double between = WeightAt((static_cast<double>(k) + 0.5) / n).w;
    row.force += T * between * series.F(axis, std::max<Eigen::Index>(0, from + k - delay));
  }
  row.still /= row.terms[4];
  return row;
}

struct AxisRows {
  Eigen::Matrix<double, Eigen::Dynamic, kUnknowns> terms;
  VectorXd forces;
};

/// Leaves windows out in which the handle stands for long, if enough are left.
void KeepMoving(std::vector<Row>* rows) {
  constexpr double kStands = 0.1;
  constexpr std::size_t kEnough = 8 * kUnknowns;
  const auto stands = [](const Row& row) { return row.still > kStands; };
  const auto standing = static_cast<std::size_t>(std::ranges::count_if(*rows, stands));
  if (rows->size() - standing >= kEnough) std::erase_if(*rows, stands);
}

AxisRows RowsOf(const Series& series, int axis, Eigen::Index delay) {
  constexpr double kWindow = 0.25;  // [s]
  const auto size = static_cast<Eigen::Index>(std::round(kWindow / series.period));
  const Eigen::Index stride = std::max<Eigen::Index>(1, size / 5);
  std::vector<Row> rows;
  for (Eigen::Index from = 0; from + size <= series.p.cols(); from += stride) {
    const bool inside = (series.axis.segment(from, size).array() == axis).all();
    if (inside) rows.push_back(RowOf(series, axis, from, size, delay));
  }
  KeepMoving(&rows);
  const auto count = static_cast<Eigen::Index>(rows.size());
  if (count < 2 * kUnknowns) throw std::runtime_error("the run is too short to tell anything by");
  AxisRows all{Eigen::Matrix<double, Eigen::Dynamic, kUnknowns>(count, kUnknowns), VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    all.terms.row(i) = rows[static_cast<std::size_t>(i)].terms;
    all.forces[i] = rows[static_cast<std::size_t>(i)].force;
  }
  return all;
}

AxisFit FitAxis(const Series& series, int axis, Eigen::Index delay) {
  const AxisRows rows = RowsOf(series, axis, delay);
  // Columns of one length, so that no unit decides what counts as small.
  const Eigen::Matrix<double, kUnknowns, 1> size =
      rows.terms.colwise().norm().transpose().cwiseMax(1e-300);
  const Eigen::Matrix<double, kUnknowns, 1> scaled =
      (rows.terms * size.cwiseInverse().asDiagonal()).colPivHouseholderQr().solve(rows.forces);
  const Eigen::Matrix<double, kUnknowns, 1> x = scaled.cwiseQuotient(size);
  AxisFit fit;
  fit.mass = x[0];
  fit.damping = x[1];
  fit.coulomb = x[2];
  fit.unexplained = (rows.terms * x - rows.forces).norm() / rows.forces.norm();
  const auto on_axis = series.axis.array() == axis;
  const double middle = on_axis.select(series.p.row(axis).transpose(), 0).sum() /
                        static_cast<double>(on_axis.count());
  fit.travel =
      on_axis.select((series.p.row(axis).transpose().array() - middle).abs(), 0).maxCoeff();
  return fit;
}

std::array<AxisFit, 3> FitAxes(const Series& series, Eigen::Index delay) {
  return {FitAxis(series, 0, delay), FitAxis(series, 1, delay), FitAxis(series, 2, delay)};
}

double LeftOver(const std::array<AxisFit, 3>& axes) {
  double sum = 0;
  for (const AxisFit& axis : axes) sum += axis.unexplained * axis.unexplained;
  return sum;
}

/// Where the parabola through three neighbours has its least, from the middle one.
double LeastBetween(double before, double at, double after) {
  const double bend = before - 2 * at + after;
  return bend > 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0;
}

/// A pair of pushes, and the share of their force that the handle's motion shows.
struct Blow {
  double asked, share;
};

std::array<std::vector<Blow>, 3> BlowsOf(const Series& series, const HandleFit& handle) {
  constexpr double kAround = 0.02;  // [s] before and behind a blow
  const auto around = static_cast<Eigen::Index>(std::round(kAround / series.period));
  const auto delay = static_cast<Eigen::Index>(std::round(handle.delay / series.period));
  std::array<std::vector<Blow>, 3> blows;
  for (Eigen::Index k = 0, end = 0; k < series.blow.size(); k = end) {
    end = k + 1;
    if (series.blow[k] == 0) continue;
    while (end < series.blow.size() && series.blow[end] == series.blow[k]) ++end;
    const Eigen::Index from = k - around, size = end - k + 2 * around;
    if (from < 0 || from + size > series.blow.size()) continue;
    const auto axis = static_cast<std::size_t>(series.axis[k]);
    const AxisFit& own = handle.axes[axis];
    const Row row = RowOf(series, static_cast<int>(axis), from, size, delay);
    const double felt =
        own.mass * row.terms[0] + own.damping * row.terms[1] + own.coulomb * row.terms[2];
    blows[axis].push_back({series.blow[k], felt / row.force});
  }
  return blows;
}

}  // namespace

HandlePhysics HandleFit::Physics() const {
  HandlePhysics handle;
  const auto least = [&](double AxisFit::*figure) {
    double value = std::numeric_limits<double>::infinity();
    for (const AxisFit& axis : axes) value = std::min(value, std::max(0.0, axis.*figure));
    return value;
  };
  handle.mass = least(&AxisFit::mass);
  handle.damping = least(&AxisFit::damping);
  handle.coulomb = least(&AxisFit::coulomb);
  return handle;
}

HandleFit FitHandle(const Recording& shaken) {
  constexpr int kLongest = 10;     // [periods] of delay
  constexpr double kMoves = 5e-4;  // [m]
  const Series series = SeriesOf(shaken);
  std::vector<double> left;
  std::vector<std::array<AxisFit, 3>> fits;
  for (int d = 0; d <= kLongest; ++d) {
    fits.push_back(FitAxes(series, d));
    left.push_back(LeftOver(fits.back()));
  }
  const auto best =
      static_cast<std::size_t>(std::min_element(left.begin(), left.end()) - left.begin());
  HandleFit fit{fits[best], static_cast<double>(best) * series.period};
  if (best > 0 && best < kLongest) {
    fit.delay += series.period * LeastBetween(left[best - 1], left[best], left[best + 1]);
  }
  for (const AxisFit& axis : fit.axes) {
    if (axis.travel >= kMoves) continue;
    throw std::runtime_error(
        fmt::format("the handle moved by {:.2g} mm only: is it held, or is the force too small? A "
                    "larger one is asked for with --force",
                    1e3 * axis.travel));
  }
  return fit;
}

PeakFit FitPeak(const Recording& struck, const HandleFit& handle) {
  constexpr double kWhole = 0.9;  // less than this share of what was asked for is less
  std::array<std::vector<Blow>, 3> blows = BlowsOf(SeriesOf(struck), handle);
  PeakFit fit;
  double least = std::numeric_limits<double>::infinity();
  for (std::vector<Blow>& rising : blows) {
    // From the hardest down to the first that came whole.
    std::ranges::sort(rising, std::greater{}, &Blow::asked);
    double sum = 0, count = 0;
    for (const Blow& blow : rising) {
      if (blow.share >= kWhole) break;
      sum += blow.share * blow.asked;
      ++count;
    }
    if (count > 0) least = std::min(least, sum / count);
    if (!rising.empty()) fit.peak = std::max(fit.peak, rising.front().asked);
  }
  if (fit.peak == 0) throw std::runtime_error("there are no blows in this recording");
  fit.reached = std::isfinite(least);
  if (fit.reached) fit.peak = least;
  return fit;
}

}  // namespace vmech
