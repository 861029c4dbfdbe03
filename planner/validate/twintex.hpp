// The Twintex plain weave of the benchmark: J. Cao and others, "Characterization of mechanical behavior of
// woven fabrics: experimental methods and benchmark results" (Composites A 39, 2008, 1037-1053). Figures were
// read from the vector graphics of the paper.
#pragma once

#include <array>
#include <limits>

namespace drapeplan::twintex {

inline constexpr double kThickness = 1.2e-3;    // [m]
inline constexpr double kArealDensity = 0.743;  // [kg/m^2]

/// Picture frames, Fig. 28: normalised shear force over the angle. The laboratories' spread is the point.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
inline constexpr std::array<double, 5> kFrameAngle{10, 20, 30, 40, 45};  // [deg]
struct Laboratory {
  const char* name;
  std::array<double, 5> force;  // [N/mm]
};
inline constexpr std::array<Laboratory, 7> kFrames{{{"HKUST", {.0013, .0160, .0409, .0892, .1394}},
                                                    {"LMSP", {.0209, .0298, .0479, .1030, .1942}},
                                                    {"UML", {.0330, .0438, .0651, .1279, .2092}},
                                                    {"UT", {.0123, .0268, .0584, kNone, kNone}},
                                                    {"KUL 1st", {.0202, .0293, .0473, .0812, kNone}},
                                                    {"KUL 3rd", {.0108, .0175, .0305, .0590, kNone}},
                                                    {"UN", {.0159, .0308, .0575, .1343, .2261}}}};

/// Bias extension, HKUST, 115 x 230 mm, 20 C, 10 mm/min, Fig. 40.
inline constexpr double kBiasWidth = 0.115, kBiasHeight = 0.230;  // [m]
inline constexpr double kBiasRate = 0.01 / 60;                    // of the crosshead [m/s]
inline constexpr std::array<double, 10> kBiasWay{0, 2.5, 5, 10, 15, 20, 25, 30, 35, 40};  // [mm]
inline constexpr std::array<double, 10> kBiasForce{0,    .62,  1.02,  1.86,  2.88,
                                                   4.35, 6.88, 10.98, 18.72, 32.42};  // [N]
/// What the paper's Eq. 18 makes of it: shear force per length at these angles.
inline constexpr std::array<double, 4> kBiasAngle{10, 20, 30, 40};              // [deg]
inline constexpr std::array<double, 4> kBiasShear{.0092, .0179, .0371, .0735};  // [N/mm]
/// The force at 25 mm in Fig. 38, of the same test as that of Fig. 40: the paper contradicts itself.
inline constexpr double kOtherForceAt25 = 2.79;  // [N]

/// Shear angle over displacement of strips of 150 x 450 mm, Fig. 36: of the kinematics, and measured by hand.
inline constexpr double kAngleWidth = 0.150, kAngleHeight = 0.450;  // [m]
inline constexpr std::array<double, 10> kTheoryAngle{3.89,  7.92,  12.12, 16.53, 21.17, 26.10,
                                                     31.41, 37.19, 43.63, 51.06};  // at 10 ... 100 mm [deg]
inline constexpr std::array<double, 8> kHandWay{5.6, 21.8, 38.3, 54.7, 71.0, 87.3, 95.4, 106.5};  // [mm]
inline constexpr std::array<double, 8> kHandAngle{1.1, 6.4, 12.7, 22.2, 29.4, 34.0, 37.9, 44.1};  // [deg]

}  // namespace drapeplan::twintex
