// Shear tests: shear stress over the angle and its rate. [Krogh], "Bias-extension Test".
#pragma once

#include <string>
#include <vector>

#include "fem/law/fabric.hpp"
#include "planner/measured/tests_file.hpp"

namespace drapeplan {

/// Crosshead force over shear angle, as measured or as the mean of several specimens.
struct ShearForce {
  std::string name;           ///< file of one specimen; of a mean the rate
  double rate = 0;            ///< of the angle, at its start [1/s]
  std::vector<double> angle;  ///< [rad]
  std::vector<double> force;  ///< [N]
};

struct ShearLaw {
  StressTable table;                  ///< in the wanted measure; nowhere falling
  std::vector<Curve> measured;        ///< by rate, the same before negative slopes were taken out
  std::vector<ShearForce> specimens;  ///< what was measured
  std::vector<ShearForce> slices;     ///< forces at constant rates, by rate
  double band = 0;                    ///< r.m.s. of what specimens differ from their mean, of the mean force
  double measured_to = 0;             ///< largest angle that all tests reached [rad]
  /// Up to where angles hold: beyond 30 degrees (bias extension) or 35 degrees (frame) those that come from
  /// the crosshead do not, since the fabric slips and bends [rad].
  double valid_to = 0;
};

struct ShearOptions {
  double thickness = 0;  ///< of the ply [m]
  ShearMeasure measure = ShearMeasure::conjugate;
  double rate_floor = 1e-3;    ///< of the law, see StressTable [1/s]
  bool by_law = true;          ///< see bias_extension_law
};

/// Shear angle in the middle of a bias-extension strip, [Krogh], Eq. (8) [rad].
/// @param displacement  of the crosshead;  @param length  L0 = H - W of the strip [m].
double bias_angle(double displacement, double length);
/// Its rate, [Krogh], Eq. (9) [1/s]. @param speed  of the crosshead [m/s].
double bias_rate(double angle, double length, double speed);

/// Crosshead force of a bias-extension strip, [Krogh], Eq. (10): its power is that of the sheared zones [N].
/// @param whole, half  conjugate shear force per length, stress times thickness, at `angle` and at half of it [N/m].
double bias_force(double whole, double half, double angle, double height, double width);

/// From bias extension. Tests of one rate are averaged. [Krogh], Eq. (10), gives the stress; it is solved from small
/// angles to large ones, and where the half angle lies in the first piece, for both at once.
/// By the law, every zone is taken at the rate that it has, and the law's curves, at the rates at which the tests
/// begin, are those that give the forces. Else as in the article: forces are laid through a surface over angle and
/// logarithm of the rate that has continuous slopes, read at these constant rates, and half-sheared zones are taken
/// at the same rate.
/// @param tests  at least one; heights at least twice their widths.
ShearLaw bias_extension_law(const std::vector<StripTest>& tests, const ShearOptions& options);

/// From picture frames: the whole fabric has one angle. With the side L of the frame and l of the fabric, force
/// F and angle g of the fabric, F_sh cos(g) = F (L / l^2) sin(pi/4 - g/2): the energy of the crosshead is that
/// of the fabric (J. Cao and others, "Characterization of mechanical behavior of woven fabrics", 2008).
/// @param tests  at least one.
ShearLaw picture_frame_law(const std::vector<FrameTest>& tests, const ShearOptions& options);

}  // namespace drapeplan
