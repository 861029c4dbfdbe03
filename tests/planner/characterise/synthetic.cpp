#include "tests/planner/characterise/synthetic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "planner/characterise/characterise.hpp"
#include "planner/method/normal.hpp"
#include "tests/planner/characterise/synthetic_strip.hpp"

namespace drapeplan::test {
namespace {

using nlohmann::json;

constexpr double kTensionWidth = 0.025, kTensionHeight = 0.150, kLargestForce = 500;
constexpr double kBiasWidth = 0.120, kBiasHeight = 0.270, kBiasWay = 0.050;
constexpr int kRows = 500;
constexpr double kStripWidth = 0.025, kLongStrip = 0.150, kOtherStrips[] = {0.100, 0.070}, kGravity = 9.81;
constexpr double kFirstFrame = 0.4, kHangs = 60;  // [s]: until no further deformation is visible
constexpr double kPixel = 2e-4;
constexpr int kFrames = 25;

class Bench {
 public:
  Bench(std::filesystem::path folder, const MaterialFields& truth, const Spoilt& spoilt)
      : folder_(std::move(folder)), fabric_(fabric_of(truth)), spoilt_(spoilt), bits_(spoilt.seed) {}

  std::string steel(int number) {
    Table table = open(fmt::format("steel_{}.csv", number));
    for (int k = 0; k <= kRows; ++k) {
      const double force = kLargestForce * k / kRows;
      row(table, 60.0 * k / kRows, machine(force), force);
    }
    return table.name;
  }

  /// @param factor  of the stress: a slower test is a little softer.
  std::string tension(double rate, double factor, int number) {
    Table table = open(fmt::format("tension_{:g}_{}.csv", 6e4 * rate, number));
    const double own = factor * (1 + spoilt_.scatter * normal());
    const double area = kTensionWidth * fabric_.thickness;
    const double slack = spoilt_.slack * (0.5 + 0.5 * std::abs(normal()));
    double force = 0;
    for (int k = 0; force < kLargestForce; ++k) {
      const double strain = 2e-5 * k;
      force = own * area * fabric_.tension.slowest()(strain);
      const double way = slack + strain * kTensionHeight + machine(force);
      if (k == 0) {
        for (int j = 0; j < 20; ++j) row(table, slack * j / 20 / rate, slack * j / 20, 0);
      }
      row(table, way / rate, way, force);
    }
    return table.name;
  }

  std::string bias(double rate, int number) {
    Table table = open(fmt::format("bias_{:g}_{}.csv", 6e4 * rate, number));
    const double own = 1 + spoilt_.scatter * normal(), length = kBiasHeight - kBiasWidth;
    for (int k = 0; k <= kRows; ++k) {
      const double way = kBiasWay * k / kRows, g = bias_angle(way, length), speed = bias_rate(g, length, rate);
      const auto c = [&](double angle, double angle_rate) {
        return fabric_.thickness * fabric_.shear(angle, angle_rate, fabric_.rate_floor);
      };
      const double force = ((2 * kBiasHeight - 3 * kBiasWidth) * c(g, speed) + kBiasWidth * c(g / 2, speed / 2)) /
                           ((kBiasHeight / kBiasWidth - 1) * (std::cos(g / 2) - std::sin(g / 2)));
      row(table, way / rate, way, own * force);
    }
    return table.name;
  }

  /// Pictures of the long strip, at times in equal ratios.
  json pictures() {
    json frames = json::array();
    const std::vector<CreepingStrip> strips = creeping_strip(fabric_, kLongStrip, kGravity, times(kFrames));
    for (const CreepingStrip& strip : strips) {
      const std::string name = fmt::format("strip_{:02}.pgm", frames.size() + 1);
      write_picture(folder_ / name, strip, kPixel, strips.back().tip(), bits_);
      frames.push_back({{"file", name}, {"time", fmt::format("{:.6g} s", strip.time)}});
    }
    return frames;
  }

  /// The tip of another strip, as a table.
  std::string tip(double length) {
    Table table{fmt::format("strip_{:g}.csv", 1e3 * length), {}};
    table.out.open(folder_ / table.name);
    table.out << "Synthetic data: computed, not measured\nTime (s);Deflection (mm)\n";
    for (const CreepingStrip& strip : creeping_strip(fabric_, length, kGravity, times(4 * kFrames)))
      table.out << fmt::format("{:.5f};{:.4f}\n", strip.time, 1e3 * (strip.tip() + spoilt_.tip_noise * normal()));
    return table.name;
  }

 private:
  static std::vector<double> times(int count) {
    std::vector<double> list;
    for (int k = 0; k < count; ++k)
      list.push_back(kFirstFrame * std::pow(kHangs / kFirstFrame, double(k) / (count - 1)));
    return list;
  }

  struct Table {
    std::string name;
    std::ofstream out;
  };

  double normal() { return standard_normal(bits_); }
  [[nodiscard]] double machine(double force) const {
    return spoilt_.compliance * std::pow(force / kLargestForce, 0.8);
  }
  Table open(const std::string& name) {
    Table table{name, std::ofstream(folder_ / name)};
    table.out << "Synthetic data: computed, not measured\nTime (s),Extension (mm),Load (N)\n";
    return table;
  }
  void row(Table& table, double time, double way, double force) {
    table.out << fmt::format("{:.4f},{:.6f},{:.4f}\n", time, 1e3 * (way + spoilt_.displacement_noise * normal()),
                             force + spoilt_.force_noise * normal());
  }

  std::filesystem::path folder_;
  Fabric fabric_;
  Spoilt spoilt_;
  std::mt19937_64 bits_;
};

json strip(const std::string& file, double width, double height, double rate) {
  return {{"file", file},
          {"width", fmt::format("{:g} mm", 1e3 * width)},
          {"height", fmt::format("{:g} mm", 1e3 * height)},
          {"rate", fmt::format("{:g} mm/min", 6e4 * rate)}};
}

}  // namespace

void write_synthetic_tests(const std::filesystem::path& folder, const MaterialFields& truth,
                           const Spoilt& spoilt) {
  constexpr double kPerMinute = 1e-3 / 60;  // [m/s]
  std::filesystem::create_directories(folder);
  Bench bench(folder, truth, spoilt);
  json tests{{"format", kTestsFormat},
             {"name", truth.name + ", synthetic"},
             {"source", "Synthetic data, computed from a known material: not measured"},
             {"thickness", fmt::format("{:g} mm", 1e3 * truth.thickness)},
             {"areal_density", fmt::format("{:g} g/m^2", 1e3 * truth.areal_density)},
             {"section_points", 5},  // the truth is the exact beam
             {"compliance", json::array()},
             {"tension", json::array()},
             {"bias_extension", json::array()},
             {"assumed", material_json(truth)}};
  for (int k = 1; k <= 3; ++k) tests["compliance"].push_back({{"file", bench.steel(k)}});
  for (const auto& [rate, factor] : {std::pair(0.5, 0.95), {2.0, 1.0}}) {
    for (int k = 1; k <= 5; ++k)
      tests["tension"].push_back(strip(bench.tension(rate * kPerMinute, factor, k), kTensionWidth,
                                       kTensionHeight, rate * kPerMinute));
  }
  for (const double rate : {2.0, 10.0, 100.0}) {
    for (int k = 1; k <= 3; ++k)
      tests["bias_extension"].push_back(
          strip(bench.bias(rate * kPerMinute, k), kBiasWidth, kBiasHeight, rate * kPerMinute));
  }
  const auto cantilever = [](double length) -> json {
    return {{"length", fmt::format("{:g} mm", 1e3 * length)}, {"width", fmt::format("{:g} mm", 1e3 * kStripWidth)}};
  };
  json first = cantilever(kLongStrip);
  first["scale"] = fmt::format("{:g} mm", 1e3 * kPixel);
  first["frames"] = bench.pictures();
  tests["cantilever"] = json::array({first});
  for (const double length : kOtherStrips) {
    tests["cantilever"].push_back(cantilever(length));
    tests["cantilever"].back()["file"] = bench.tip(length);
  }
  std::ofstream(folder / "tests.json") << tests.dump(2) << '\n';
}

}  // namespace drapeplan::test
