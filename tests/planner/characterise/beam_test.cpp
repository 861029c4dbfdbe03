#include "planner/characterise/beam.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planner/method/normal.hpp"

namespace drapeplan {
namespace {

TEST(StripAtRest, IsTheHeavyElastica) {
  // beta = load length^3 / D, tip drop over length.
  for (const auto& [beta, drop] : {std::pair(1.0, 0.12347), {4.0, 0.42516}, {10.0, 0.70020}}) {
    const StripAtRest strip = strip_at_rest(linear_bending(1 / beta), 1, 1);
    EXPECT_NEAR(strip.tip(), drop, 1e-5) << beta;
    EXPECT_NEAR(strip.moment.back(), 0, 1e-9);
    EXPECT_NEAR(stiffness_of(strip.tip(), 1, 1), 1 / beta, 1e-6 / beta);
  }
  EXPECT_THROW(stiffness_of(2, 1, 1), std::invalid_argument);
}

TEST(StripAtRest, FollowsALawThatSoftens) {
  // Curvature 100 times as soft above a moment: the strip hangs down from a hinge beside the clamp.
  const BendingLaw soft{{0, 0.1, 0.101}, {0, 0.01, 1.01}};
  const StripAtRest strip = strip_at_rest(soft, 1, 1);
  for (size_t k = 0; k < strip.moment.size(); ++k)
    EXPECT_NEAR(soft(strip.moment[k]), strip.curvature[k], 1e-9);
  EXPECT_GT(strip.tip(), 0.9);
}

// A strip that softens by two orders of magnitude, 250 mm long, as another program has it: place [m], curvature
// [1/m] and moment per width [N]. Source: results of the simulator of github.com/phbroberg/bendstiff (MIT licence);
// its load is 13.6 N/m^2.
struct OtherPlace {
  double x, y, curvature, moment;
};
constexpr OtherPlace kOther[] = {
    {0, 0, 19.5691, 0.392772}, {0.00499475, -0.000229182, 16.8876, 0.375935},
    {0.0099524, -0.000878579, 14.2061, 0.35956}, {0.0148515, -0.00187795, 11.5875, 0.343712},
    {0.0196846, -0.00315912, 9.22702, 0.328407}, {0.0244535, -0.00466163, 7.18419, 0.31363},
    {0.0291655, -0.00633427, 5.45751, 0.29935}, {0.0338301, -0.00813471, 4.02259, 0.285532},
    {0.0384576, -0.0100285, 2.85339, 0.272138}, {0.0430576, -0.011988, 1.9315, 0.259137},
    {0.0476385, -0.0139918, 1.24659, 0.246503}, {0.0522069, -0.016024, 0.789736, 0.234214},
    {0.0567672, -0.0180742, 0.540568, 0.222257}, {0.061322, -0.0201368, 0.444385, 0.210625},
    {0.0658722, -0.0222094, 0.413075, 0.199314}, {0.0704181, -0.0242914, 0.390307, 0.188324},
    {0.0749599, -0.0263823, 0.3682, 0.177653}, {0.0794979, -0.0284816, 0.346752, 0.1673},
    {0.0840322, -0.0305887, 0.32596, 0.157264}, {0.0885631, -0.0327032, 0.305824, 0.147545},
    {0.0930907, -0.0348246, 0.286341, 0.13814}, {0.0976153, -0.0369525, 0.26751, 0.12905},
    {0.102137, -0.0390865, 0.249328, 0.120274}, {0.106656, -0.0412261, 0.231795, 0.111811},
    {0.111173, -0.0433709, 0.214908, 0.10366}, {0.115687, -0.0455206, 0.198667, 0.0958202},
    {0.120199, -0.0476747, 0.18307, 0.0882917}, {0.124709, -0.049833, 0.168117, 0.0810736},
    {0.129218, -0.0519951, 0.153805, 0.0741655}, {0.133724, -0.0541606, 0.140135, 0.0675668},
    {0.13823, -0.0563293, 0.127105, 0.0612772}, {0.142734, -0.0585009, 0.114714, 0.0552962},
    {0.147236, -0.060675, 0.102962, 0.0496235}, {0.151738, -0.0628515, 0.0918482, 0.0442588},
    {0.156238, -0.06503, 0.0813716, 0.0392017}, {0.160738, -0.0672104, 0.0715319, 0.0344521},
    {0.165236, -0.0693923, 0.0623286, 0.0300096}, {0.169734, -0.0715757, 0.0537613, 0.0258742},
    {0.174232, -0.0737603, 0.0458297, 0.0220456}, {0.178729, -0.0759459, 0.0385334, 0.0185237},
    {0.183226, -0.0781323, 0.0318722, 0.0153083}, {0.187722, -0.0803195, 0.0258459, 0.0123994},
    {0.192218, -0.0825073, 0.0204543, 0.00979681}, {0.196714, -0.0846955, 0.0156972, 0.00750055},
    {0.201209, -0.086884, 0.0115745, 0.00551054}, {0.205705, -0.0890729, 0.00808624, 0.00382673},
    {0.2102, -0.0912619, 0.00523224, 0.00244909}, {0.214695, -0.093451, 0.00301249, 0.00137761},
    {0.21919, -0.0956402, 0.00142696, 0.000612269}, {0.223686, -0.0978294, 0.000475654, 0.000153067},
    {0.228181, -0.100019, 0, 0}};
constexpr double kOtherLength = 0.25, kOtherLoad = 13.6;

BendingLaw other_law() {
  BendingLaw law;
  for (size_t k = std::size(kOther); k-- > 0;) {
    law.strain.push_back(kOther[k].moment);
    law.stress.push_back(kOther[k].curvature);
  }
  return law;
}

std::vector<Eigen::Vector2d> other_places() {
  std::vector<Eigen::Vector2d> places;
  for (const OtherPlace& one : kOther) places.emplace_back(one.x, one.y);
  return places;
}

TEST(BendingLawOfProfile, TakesAnotherProgramsLawToItsShape) {
  const StripAtRest strip = strip_at_rest(other_law(), kOtherLength, kOtherLoad);
  EXPECT_NEAR(strip.places.back().x(), 0.22818, 0.01 * 0.22818);
  EXPECT_NEAR(strip.places.back().y(), -0.10002, 0.01 * 0.10002);
}

TEST(BendingLawOfProfile, TakesAnotherProgramsShapeToItsLaw) {
  const BendingLaw law = bending_law_of_profile(other_places(), kOtherLoad, 25);
  EXPECT_NEAR(law.strain.back(), 0.39277, 0.01 * 0.39277);
  double squares = 0;
  int count = 0;
  for (const OtherPlace& one : kOther) {
    if (one.moment < 0.03) continue;  // as good as straight
    const double missed = law(one.moment) / one.curvature - 1;
    EXPECT_NEAR(missed, 0, 0.12) << one.moment;  // most where the law bends sharply, between its pieces
    squares += missed * missed;
    ++count;
  }
  EXPECT_EQ(count, 37);
  EXPECT_LT(std::sqrt(squares / count), 0.04);
  const StripAtRest again = strip_at_rest(law, kOtherLength, kOtherLoad);
  EXPECT_NEAR(again.tip(), 0.10002, 0.01 * 0.10002);
}

TEST(BendingLawOfProfile, FindsALawThroughNoise) {
  const BendingLaw truth{{0, 0.1, 0.6}, {0, 0.4, 12}};
  const StripAtRest strip = strip_at_rest(truth, 1, 1);
  std::mt19937_64 bits(1);
  std::vector<Eigen::Vector2d> places;
  for (size_t k = 0; k < strip.places.size(); k += 10)
    places.push_back(strip.places[k] + 5e-4 * Eigen::Vector2d(0, k > 0 ? standard_normal(bits) : 0));
  const BendingLaw law = bending_law_of_profile(places, 1, 10);
  for (size_t k = 1; k < law.stress.size(); ++k) EXPECT_GE(law.stress[k], law.stress[k - 1]);
  for (double moment = 0.05; moment <= strip.moment.front(); moment += 0.05)
    EXPECT_NEAR(law(moment), truth(moment), 0.1 * truth(strip.moment.front())) << moment;
  EXPECT_NEAR(strip_at_rest(law, 1, 1).tip(), strip.tip(), 0.002 * strip.tip());
}

TEST(BendingLawOfProfile, RefusesTooFewPlacesAndAStripThatTurnsBack) {
  EXPECT_THROW(bending_law_of_profile(other_places(), kOtherLoad, 26), std::invalid_argument);
  std::vector<Eigen::Vector2d> back = other_places();
  for (size_t k = 30; k < back.size(); ++k) back[k].x() = 2 * back[30].x() - back[k].x();
  EXPECT_THROW(bending_law_of_profile(back, kOtherLoad), std::invalid_argument);
}

TEST(SectionMoment, HasTheClosedFormOfTwoModuli) {
  const double thickness = 0.3e-3, in_tension = 8e9, in_compression = 0.5e9;
  const Curve tension{{0, 1}, {0, in_tension}}, compression{{0, 0.001, 1}, {0, 0.5e6, 0.5e9}};
  const double sum = std::sqrt(in_tension) + std::sqrt(in_compression);
  const double stiffness = std::pow(thickness, 3) / 12 * 4 * in_tension * in_compression / (sum * sum);
  for (const double curvature : {0.1, 3.0, 20.0})
    EXPECT_NEAR(section_moment(tension, compression, thickness, curvature), stiffness * curvature,
                1e-9 * stiffness * curvature);
}

}  // namespace
}  // namespace drapeplan
