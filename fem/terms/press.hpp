// A pressure on the ply's upper face once it has been laid down, as a vacuum bag or a roller gives it.
#pragma once

#include <memory>
#include <optional>
#include <tuple>

#include "fem/core/term.hpp"
#include "fem/mesh/mesh.hpp"
#include "fem/rig/schedule.hpp"

namespace drapeplan {

/// Times are of the schedule's clock. The pressure rises smoothly, then stays; the run ends with it, under
/// pressure.
struct Press {
  double pressure = 0;  ///< [Pa]
  /// From the end of the last stroke, or of a run without schedule; absent: from the schedule's end [s].
  std::optional<double> delay = {};
  double duration = 2;  ///< the ramp included: by default it holds as long as it rises [s]
  double ramp = 1;  ///< to the full pressure [s]: by default no faster than the fastest stroke of a search
};

inline auto fields_of(const Press& of) {
  const auto& [pressure, delay, duration, ramp] = of;
  return std::tie(pressure, delay, duration, ramp);
}

/// @throws WrongInput if a value is not finite or negative, or the ramp is not within the duration.
void check_press(const Press& press);

/// When pressing begins, has its full pressure, and ends with the run [s].
struct PressTimes {
  double start = 0, full = 0, end = 0;
  friend PressTimes operator/(const PressTimes& t, double scaling) {
    return {t.start / scaling, t.full / scaling, t.end / scaling};
  }
};

/// @param schedule  null without one;  @param end  of the schedule, or of a run without one [s].
PressTimes press_times(const Press& press, const Schedule* schedule, double end);

/// Pressure at time t, with a continuous slope [Pa]. @param full  pressure [Pa].
double pressure_at(const PressTimes& times, double full, double t);

/// Presses the ply with `State::pressure` from its upper face, against its normal: towards the mold that it
/// lies on. It follows the ply: forces on nodes are those of the bilinear elements as they are now, so that
/// their work is the pressure times the volume that the ply sweeps, exactly.
/// @param press  for the bound of its stiffness.
std::unique_ptr<Term> make_press(const Press& press, const Mesh& mesh);

}  // namespace drapeplan
