//%% [markdown]
// # Stability
//
// A stiff virtual wall against a real handle can throw the hand back: between two samples the force
// stands still while the handle moves on, and that is energy from nowhere. How stiff may a spring
// be? What do delay and differentiation cost? This chapter sweeps gains until something swings up,
// and compares with the bounds that `vmech haptic` prints.

//%%
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "notebook.h"
#include "vmech/hw_interface/estimation/estimators.h"
#include "vmech/hw_interface/safety/stability.h"

using namespace vmech;

namespace {

constexpr double kPeriod = 1e-3;

/// A handle m x'' + b x' = F against a rendered spring -K x - B v, v from differences, with the
/// force of `delay` periods ago. True if a swing dies out: the fourth quarter of ten seconds swings
/// less than the second.
bool DiesOut(const HandlePhysics& handle, double K, double B, int delay) {
  constexpr int kTicks = 10000;
  const double decay = std::exp(-handle.damping / handle.mass * kPeriod);
  const double rest = (1 - decay) * handle.mass / handle.damping;
  std::array<double, 8> force{};
  std::array<double, 4> swing{};
  double x = 1e-3, v = 0, before = x;
  for (int k = 0; k < kTicks; ++k) {
    std::move_backward(force.begin(), force.end() - 1, force.end());
    force[0] = -K * x - B * (x - before) / kPeriod;
    before = x;
    const double F = force[delay];
    x += rest * v + (kPeriod - rest) / handle.damping * F;
    v = decay * v + rest / handle.mass * F;
    if (std::abs(x) > 1e3) return false;
    double& largest = swing[4 * k / kTicks];
    largest = std::max(largest, std::abs(x));
  }
  return swing[3] < swing[1] || swing[3] < 1e-12;
}

/// The stiffest spring that dies out, by bisection.
double Stiffest(const HandlePhysics& handle, double B, int delay) {
  double low = 1, high = 1e6;
  while (high / low > 1.001) {
    const double K = std::sqrt(low * high);
    (DiesOut(handle, K, B, delay) ? low : high) = K;
  }
  return low;
}

/// Error of the acceleration over the signal, root mean square, of a swing behind an encoder.
template <typename Estimator>
double AccelerationError(Estimator estimator, int bits) {
  const double count = 2 * std::numbers::pi / std::ldexp(1, bits);
  const double rate = 2 * std::numbers::pi * 1.5;
  double error = 0, signal = 0;
  for (int k = 0; k < 4000; ++k) {
    const double x = 0.3 * std::sin(rate * k * kPeriod), a = -rate * rate * x;
    const double found = estimator.Update(count * std::round(x / count)).a;
    if (k < 1000) continue;
    error += (found - a) * (found - a);
    signal += a * a;
  }
  return std::sqrt(error / signal);
}

}  // namespace

//%% tags=["remove-cell"]
int main(int argc, char** argv) {
  Notebook notebook(argc, argv);

  //%% [markdown]
  // ## A spring, and delay
  //
  // A sampled spring of stiffness $K$ acts late: by half a period, which the hold costs, and by the
  // delay $t_d$ of the device. A late spring is a spring and a damper below zero, $-K (T/2 + t_d)$.
  // The handle's own damping $b$ has to pay for it:
  //
  // $$
  // K \left(\frac{T}{2} + t_d\right) \le b
  // $$

  //%%
  const HandlePhysics handle{1, 2, 0, 0, 20, 2};  // 1 kg, 2 N s/m
  plot::LinePlot delays;
  delays.title = "The stiffest spring that does not swing up";
  delays.x = {"delay", "ms"};
  delays.y = {"stiffness", "N/m", plot::ScaleType::kLog};
  delays.series = {{"swept", {}, {}, plot::LineStyle::kSolid, plot::Marker::kCircle},
                   {"b / (T/2 + delay)", {}, {}, plot::LineStyle::kDashed}};
  for (int delay = 0; delay <= 5; ++delay) {
    const double swept = Stiffest(handle, 0, delay);
    const double bound = BoundsOf(handle, kPeriod, delay * kPeriod).stable_stiffness;
    for (plot::Series& series : delays.series) series.x.push_back(delay);
    delays.series[0].y.push_back(swept);
    delays.series[1].y.push_back(bound);
    notebook.CheckNear(fmt::format("swept over bound, {} ms late", delay), swept / bound, 1, 0.05);
  }
  notebook.Show(delays);

  //%% [markdown]
  // ## A damper helps, up to a point
  //
  // A rendered damper $B$ adds to $b$. But it differentiates the position, and is late itself.
  // Beyond some gain it makes things worse: its own loop, $B T / m$, swings up. The virtual
  // coupling lives on this curve, well below its top.

  //%%
  plot::LinePlot dampers;
  dampers.title = "With a rendered damper";
  dampers.x = {"rendered damping", "N s/m"};
  dampers.y = {"stiffest spring", "N/m", plot::ScaleType::kLog};
  dampers.series = {{"no delay", {}, {}, plot::LineStyle::kSolid},
                    {"1 ms late", {}, {}, plot::LineStyle::kDashed}};
  double best = 0, last = 0;
  for (double B = 0; B <= 1900; B += 100) {
    for (int delay = 0; delay < 2; ++delay) {
      const double K = Stiffest(handle, B, delay);
      dampers.series[delay].x.push_back(B);
      dampers.series[delay].y.push_back(K);
      if (delay == 0) best = std::max(best, last = K);
    }
  }
  notebook.Show(dampers);
  notebook.Print(
      fmt::format("best {:.3g} N/m; without a damper {:.3g} N/m; with too much {:.3g} N/m", best,
                  dampers.series[0].y[0], last));
  notebook.Check("a damper makes the spring ten times as stiff",
                 best > 10 * dampers.series[0].y[0]);
  notebook.Check("too much of it spoils that", last < best / 2);

  //%% [markdown]
  // ## Differentiating an encoder
  //
  // The paper renders inertia from the acceleration, differentiated twice from the encoder. A step
  // of the encoder, over the period squared, is the noise of that. Three ways to do it, with a
  // swing of 0.3 rad at 1.5 Hz:

  //%%
  plot::LinePlot noise;
  noise.title = "What is wrong with the acceleration";
  noise.x = {"encoder", "bits"};
  noise.y = {"error over signal", "", plot::ScaleType::kLog};
  noise.series = {{"differences", {}, {}, plot::LineStyle::kSolid, plot::Marker::kCircle},
                  {"Kalman", {}, {}, plot::LineStyle::kDashed},
                  {"quadratic fit", {}, {}, plot::LineStyle::kDashed}};
  double differences = 0, kalman = 0;
  for (const int bits : {12, 14, 16, 18, 20}) {
    const double count = 2 * std::numbers::pi / std::ldexp(1, bits);
    for (plot::Series& series : noise.series) series.x.push_back(bits);
    noise.series[0].y.push_back(AccelerationError(FiniteDifferences(kPeriod), bits));
    noise.series[1].y.push_back(AccelerationError(KalmanEstimator<>(kPeriod, count), bits));
    noise.series[2].y.push_back(AccelerationError(QuadraticFit(kPeriod, 20), bits));
    if (bits != 16) continue;
    differences = noise.series[0].y.back();
    kalman = noise.series[1].y.back();
  }
  notebook.Show(noise);
  notebook.Print(fmt::format("16 bits: differences {:.0f} %, Kalman {:.0f} % of the signal",
                             100 * differences, 100 * kalman));
  notebook.Check("differences are worse than the signal", differences > 1);
  notebook.Check("the Kalman filter leaves less than a third", kalman < 0.33);

  //%% [markdown]
  // Less noise is bought with delay, and delay costs stability. A mass $M$ that is rendered by the
  // force $-M a$ on a handle of mass $m$ is a feedback of the handle's own acceleration with the
  // gain $r = M / m$, and it acts late. How large may $r$ be?
  //
  // Take second differences $d_k = x_k - 2 x_{k-1} + x_{k-2}$, the force $F_k = -M d_k / T^2$ held
  // for a period $T$, and a free handle without damping, $m x'' = F$. Then two neighbouring forces
  // move the handle by
  //
  // $$
  // d_{k+1} = \frac{T^2}{2 m} (F_k + F_{k-1}) = -\frac{r}{2} (d_k + d_{k-1}),
  // \qquad z^2 + \frac{r}{2} z + \frac{r}{2} = 0
  // $$
  //
  // The two roots lie within the unit circle exactly if $r < 2$: a free handle can be given less
  // than twice its own mass in this way. The bound is that of one method and one hand. A filter
  // with more delay, a delay of the device, or a hand that holds the handle each gives another one;
  // the table in `docs/haptic.md` has them, measured. The virtual coupling of chapter 6 has no such
  // bound, because it never asks for an acceleration.

  //%% tags=["remove-cell"]
  return notebook.ExitCode();
}
