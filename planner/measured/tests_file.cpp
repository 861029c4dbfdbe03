#include "planner/measured/tests_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "mapping/error.hpp"
#include "planner/base/quantity.hpp"
#include "planner/case/section_fields.hpp"
#include "planner/input/document.hpp"
#include "planner/input/kit.hpp"
#include "planner/input/reader.hpp"

namespace drapeplan {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Strain of fibres beyond which a table holds something else.
constexpr double kLargestTension = 0.2;
/// How far what moves may seem to go back, of its whole way: more than noise.
constexpr double kCrossheadNoise = 0.02, kTipNoise = 0.2;

void visit_columns(FieldVisitor& v, ColumnNames& names, bool angle) {
  v.section({"columns", "What columns of the file are called, where that is not usual", false, {}, true}, true,
            [&] {
              v.field({"time", &names.time, "Name of the column of times"});
              v.field({"displacement", &names.displacement, "Name of the column of crosshead displacements"});
              v.field({"force", &names.force, "Name of the column of forces"});
              if (angle)
                v.field({"angle", &names.angle,
                         "Name of the column of measured shear angles, which then replace those from the "
                         "crosshead"});
            });
}

void visit_file(FieldVisitor& v, std::string& file) {
  v.field({"file", &file, "Text table of the test machine, relative to this file", Dimension::none, {}, true});
}

void visit_rate(FieldVisitor& v, double& rate) {
  v.field({"rate", &rate, "Speed of the crosshead", Dimension::velocity, positive(1), true});
}

void visit_strip(FieldVisitor& v, StripTest& test, bool angle) {
  visit_file(v, test.file);
  v.field({"width", &test.width, "Of the specimen", Dimension::length, positive(kLargestLength), true});
  v.field({"height", &test.height, "Between the clamps, before the test", Dimension::length,
           positive(kLargestLength), true});
  visit_rate(v, test.rate);
  visit_columns(v, test.columns, angle);
}

void visit_cantilever(FieldVisitor& v, CantileverTest& test) {
  v.field({"length", &test.length, "Free length", Dimension::length, positive(kLargestLength), true});
  v.field({"width", &test.width, "Of the strip", Dimension::length, positive(kLargestLength), true});
  v.field({"file", &test.file, "Text table of times and deflections of the tip, relative to this file"});
  v.section({"columns", "What columns of the file are called, where that is not usual", false, {}, true}, true,
            [&] {
              v.field({"time", &test.columns.time, "Name of the column of times"});
              v.field({"deflection", &test.columns.deflection, "Name of the column of deflections"});
            });
  v.list(object_list("frames", "Pictures instead of a table, in the order of time", test.frames,
                     [&v](StripFrame& frame) {
                       v.field({"file", &frame.file, "PNG, PGM, PPM or JPEG, relative to this file",
                                Dimension::none, {}, true});
                       v.field({"time", &frame.time, "Since the strip was let go", Dimension::time, from(0), true});
                     }));
  StripImageOptions& image = test.image;
  v.field({"scale", &image.scale, "Size of a pixel", Dimension::length, from(0)});
  v.field({"threshold", &image.threshold, "Between black (0) and white (1): brighter is strip", Dimension::none,
           from(0, 1)});
  v.field({"dark", &image.dark, "The strip is darker than the threshold"});
  v.field({"clamp_right", &image.clamp_right, "The clamp is on the right of the pictures"});
  v.field({"smallest_area", &image.smallest_area, "Smaller patches are no strip [pixels]", Dimension::none,
           from(1)});
}

void visit_tests(FieldVisitor& v, Tests& tests) {
  int format = 0;
  v.field({"format", choice(format, {kTestsFormat}), "What this file is", Dimension::none, {}, true});
  v.field({"name", &tests.name, "What the material is called"});
  v.field({"source", &tests.source, "Who made the tests, where and when"});
  v.field({"thickness", &tests.thickness, "Of the ply", Dimension::length, positive(0.05), true});
  v.field({"areal_density", &tests.areal_density, "Mass per area", Dimension::areal_density, positive(100),
           true});
  v.list(object_list("compliance",
                     "Tests of a stiff specimen in the same clamps: their displacement is the machine's, and "
                     "is subtracted",
                     tests.compliance, [&v](ComplianceTest& test) {
                       visit_file(v, test.file);
                       visit_columns(v, test.columns, false);
                     }));
  v.list(object_list("tension", "Strips pulled along the fibres", tests.tension,
                     [&v](StripTest& test) { visit_strip(v, test, false); }));
  v.list(object_list("bias_extension", "Strips with fibres at +-45 degrees, at least twice as high as wide",
                     tests.bias_extension, [&v](StripTest& test) { visit_strip(v, test, true); }));
  v.list(object_list("picture_frame", "Squares sheared in a frame of four bars", tests.picture_frame,
                     [&v](FrameTest& test) {
                       visit_file(v, test.file);
                       v.field({"side", &test.side, "Of the frame, between its hinges", Dimension::length,
                                positive(kLargestLength), true});
                       Field specimen{"specimen", &test.specimen, "Side of the fabric", Dimension::length,
                                      positive(kLargestLength)};
                       specimen.default_words = "that of the frame";
                       v.field(specimen);
                       visit_rate(v, test.rate);
                       visit_columns(v, test.columns, true);
                     }));
  v.list(object_list("cantilever", "Strips clamped at one end that bend under their weight", tests.cantilever,
                     [&v](CantileverTest& test) { visit_cantilever(v, test); }));
  v.field({"transverse_shear_modulus", &tests.transverse_shear_modulus,
           "Chosen one; the page shows what the slopes at the clamp say", Dimension::stress, positive()});
  v.field({"gravity", &tests.gravity, "Acceleration of the cantilevers", Dimension::acceleration, positive(100)});
  v.field({"section_points", &tests.section_points,
           "Of simulated cantilevers, 3 or 5: those of the cases that will use the material (`fem.section_points`). "
           "Three see so little of a compression curve with a break that a strip of 150 mm drops 7 mm deeper",
           Dimension::none, from(3, 5)});
  v.field({"shear_measure", choice(tests.shear_measure, {"conjugate", "force"}),
           "Of the material's shear curves, see material.shear.measure"});
  v.field({"shear_rates", choice(tests.shear_rates, {"law", "article"}),
           "Rates of a bias extension: `law` takes every zone at the rate that it has; `article` reads forces at "
           "constant rates, and takes half-sheared zones at the same rate ([Krogh], Eq. (10))"});
  optional_section(v,
                   {"assumed", "Material, or the name of its file, that gives what is not tested"},
                   tests.assumed, MaterialFields(), [&v](MaterialFields& m) { visit_material(v, m); });
}

/// Reads data files and looks for what no single field shows.
class DataReader {
 public:
  DataReader(std::filesystem::path folder, FieldReader& reader)
      : folder_(std::move(folder)), reader_(reader) {}

  void read(Tests& tests) {
    for (size_t k = 0; k < tests.compliance.size(); ++k)
      table(tests.compliance[k], fmt::format("/compliance/{}", k), false, kInfinity);
    for (size_t k = 0; k < tests.tension.size(); ++k)
      table(tests.tension[k], fmt::format("/tension/{}", k), false,
            kLargestTension * tests.tension[k].height);
    for (size_t k = 0; k < tests.bias_extension.size(); ++k) {
      const std::string pointer = fmt::format("/bias_extension/{}", k);
      const StripTest& test = tests.bias_extension[k];
      const bool sizes = reader_.good(pointer + "/width") && reader_.good(pointer + "/height");
      if (sizes && !(test.height >= 2 * test.width))
        reader_.fail(pointer + "/height",
                     fmt::format("is less than twice the width ({}): no zone of the strip is then free of both "
                                 "clamps, and Eq. (10) does not hold",
                                 format_quantity(test.width, Dimension::length)));
      table(tests.bias_extension[k], pointer, true, (std::numbers::sqrt2 - 1) * (test.height - test.width));
    }
    for (size_t k = 0; k < tests.picture_frame.size(); ++k)
      table(tests.picture_frame[k], fmt::format("/picture_frame/{}", k), true,
            (2 - std::numbers::sqrt2) * tests.picture_frame[k].side);
    for (size_t k = 0; k < tests.cantilever.size(); ++k)
      cantilever(tests.cantilever[k], fmt::format("/cantilever/{}", k));
    const bool any = !tests.cantilever.empty() || !tests.tension.empty() || !tests.bias_extension.empty() || !tests.picture_frame.empty();
    if (!any && reader_.errors().empty()) reader_.add_error("", "names no tests");
  }

  [[nodiscard]] std::vector<InputError>& errors() { return errors_; }

 private:
  /// @param longest  way of the crosshead that the specimen allows [m].
  template <class Test>
  void table(Test& test, const std::string& pointer, bool angle, double longest) {
    if (!reader_.good(pointer + "/file")) return;
    std::vector<WantedColumn> wanted{{TestQuantity::time, false, test.columns.time},
                                     {TestQuantity::displacement, true, test.columns.displacement},
                                     {TestQuantity::force, true, test.columns.force}};
    if (angle) wanted.push_back({TestQuantity::angle, false, test.columns.angle});
    for (WantedColumn& column : wanted) column.required = column.required || !column.header.empty();
    TableReading reading = read_test_table(folder_ / test.file, wanted);
    if (reading.errors.empty()) {
      double rate = 0;
      if constexpr (requires { test.rate; }) rate = reader_.good(pointer + "/rate") ? test.rate : 0;
      const std::string name = (folder_ / test.file).string();
      check_order(reading.table, name, TestQuantity::displacement, kCrossheadNoise);
      check_way(reading.table, name, rate, longest);
      check_slip(reading.table, name);
    }
    errors_.insert(errors_.end(), reading.errors.begin(), reading.errors.end());
    test.table = std::move(reading.table);
  }

  void cantilever(CantileverTest& test, const std::string& pointer) {
    if (!reader_.good(pointer)) return;
    if (test.file.empty() == test.frames.empty())
      return reader_.fail(pointer, "needs either a file with the deflections of its tip or frames, not both");
    if (!test.file.empty()) {
      TableReading reading = read_test_table(folder_ / test.file,
                                             {{TestQuantity::time, true, test.columns.time},
                                              {TestQuantity::deflection, true, test.columns.deflection}});
      errors_.insert(errors_.end(), reading.errors.begin(), reading.errors.end());
      test.table = std::move(reading.table);
      if (reading.errors.empty()) {
        check_order(test.table, (folder_ / test.file).string(), TestQuantity::deflection, kTipNoise);
        check_drop(test, (folder_ / test.file).string());
      }
      return;
    }
    if (!(test.image.scale > 0)) return reader_.add_error(pointer, "\"scale\" is missing: the size of a pixel");
    for (size_t k = 0; k < test.frames.size(); ++k) frame(test, k, fmt::format("{}/frames/{}", pointer, k));
  }

  void frame(CantileverTest& test, size_t k, const std::string& pointer) {
    StripFrame& one = test.frames[k];
    if (k > 0 && !(one.time > test.frames[k - 1].time))
      reader_.fail(pointer + "/time", "times must increase");
    const std::string file = (folder_ / one.file).string();
    try {
      one.line = strip_midline(read_image(file), test.image);
      double length = 0;
      for (size_t n = 1; n < one.line.size(); ++n) length += (one.line[n] - one.line[n - 1]).norm();
      constexpr double kLengthTolerance = 0.1;
      if (std::abs(length - test.length) > kLengthTolerance * test.length)
        throw WrongInput(fmt::format("the strip is {:.4g} mm long, not {:.4g} mm: the wrong scale, threshold or "
                                     "clamp",
                                     1e3 * length, 1e3 * test.length));
      constexpr double kAbove = 0.02;  // of the length
      if (one.line.back().y() > kAbove * test.length)
        throw WrongInput("the strip ends above its clamp: is the clamp on the other side (`clamp_right`)?");
    } catch (const WrongInput& error) {
      const std::string reason = error.what();
      errors_.push_back({file, 0, "", reason.starts_with(file) ? reason.substr(file.size() + 2) : reason});
    }
  }

  void fail(const std::string& file, int line, TestQuantity quantity, std::string message) {
    errors_.push_back({file, line, quantity_name(quantity), std::move(message)});
  }

  /// Times increase, and so does, but for noise, what moves. @param noise  that is possible, of the whole way.
  void check_order(const TestTable& table, const std::string& file, TestQuantity moves, double noise) {
    const std::vector<double>& way = table[moves];
    for (size_t k = 1; k < table.rows(); ++k) {
      if (table.has(TestQuantity::time) && !(table[TestQuantity::time][k] > table[TestQuantity::time][k - 1]))
        return fail(file, table.lines[k], TestQuantity::time, "does not increase: rows are not in their order");
      if (way[k] < way[k - 1] - noise * range(way))
        return fail(file, table.lines[k], moves,
                    fmt::format("jumps back from {:.4g} to {:.4g} mm: rows are not in their order, or the "
                                "columns are swapped",
                                1e3 * way[k - 1], 1e3 * way[k]));
    }
  }

  /// A strip's tip hangs no lower than the strip is long, not above its clamp, and comes down ever more slowly.
  void check_drop(const CantileverTest& test, const std::string& file) {
    const std::vector<double>&time = test.table[TestQuantity::time], &drop = test.table[TestQuantity::deflection];
    constexpr double kAbove = 0.05;   // of the length: more than noise
    constexpr double kHalfway = 0.4;  // of the way, after half of the time: what creeps is further than this
    for (size_t k = 0; k < drop.size(); ++k) {
      const int line = test.table.lines[k];
      if (drop[k] > test.length)
        return fail(file, line, TestQuantity::deflection,
                    fmt::format("{:.4g} mm is deeper than the strip is long, {:.4g} mm: the wrong unit, column or "
                                "length",
                                1e3 * drop[k], 1e3 * test.length));
      if (drop[k] < -kAbove * test.length)
        return fail(file, line, TestQuantity::deflection,
                    fmt::format("{:.4g} mm lies above the clamp; deflections are > 0 downwards", 1e3 * drop[k]));
      if (time[k] - time.front() < 0.5 * (time.back() - time.front())) continue;
      if (drop[k] - drop.front() < kHalfway * (drop.back() - drop.front()))
        return fail(file, line, TestQuantity::deflection,
                    "grows ever faster, but a strip comes down ever more slowly: are the columns swapped?");
      return;
    }
  }

  /// The crosshead goes as fast as stated, and no further than the specimen allows.
  void check_way(const TestTable& table, const std::string& file, double rate, double longest) {
    const std::vector<double>& way = table[TestQuantity::displacement];
    if (range(way) > longest)
      fail(file, table.lines.back(), TestQuantity::displacement,
           fmt::format("grows by {:.4g} mm, but this specimen allows {:.4g} mm: the wrong unit, size or column",
                       1e3 * range(way), 1e3 * longest));
    if (rate <= 0 || !table.has(TestQuantity::time)) return;
    const double seconds = table[TestQuantity::time].back() - table[TestQuantity::time].front();
    const double measured = (way.back() - way.front()) / seconds;
    constexpr double kRateTolerance = 0.2;
    if (!(std::abs(measured - rate) <= kRateTolerance * rate))
      fail(file, table.lines.back(), TestQuantity::displacement,
           fmt::format("grows by {:.3g} mm/min, but the test's rate is {:.3g} mm/min: the wrong unit, rate or "
                       "column",
                       6e4 * measured, 6e4 * rate));
  }

  /// A force that falls at once, and rises again, is a specimen that slipped.
  void check_slip(const TestTable& table, const std::string& file) {
    const std::vector<double>&way = table[TestQuantity::displacement], &force = table[TestQuantity::force];
    constexpr double kFall = 0.1;      // of the largest force
    constexpr double kAtOnce = 0.005;  // of the whole way
    const double largest = *std::max_element(force.begin(), force.end());
    size_t first = 0;
    for (size_t k = 0; k < table.rows(); ++k) {
      while (way[k] - way[first] > kAtOnce * range(way)) ++first;
      const double before = *std::max_element(force.begin() + std::ptrdiff_t(first), force.begin() + std::ptrdiff_t(k) + 1);
      if (before - force[k] < kFall * largest) continue;
      const double after = *std::max_element(force.begin() + std::ptrdiff_t(k), force.end());
      if (after < before) return;  // it never rises again: the specimen failed, or the test was over
      return fail(file, table.lines[k], TestQuantity::force,
                  fmt::format("falls from {:.4g} to {:.4g} N at once, at {:.4g} mm, and rises again: did the "
                              "specimen slip in its clamps?",
                              before, force[k], 1e3 * way[k]));
    }
  }

  static double range(const std::vector<double>& values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return *high - *low;
  }

  std::filesystem::path folder_;
  FieldReader& reader_;
  std::vector<InputError> errors_;
};

}  // namespace

TestsReading read_tests(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  const InputDocument document(file, overrides, {"assumed"});
  TestsReading reading;
  reading.errors = document.errors();
  if (!document.root().is_object()) return reading;
  reading.tests.name = file.stem().string();
  FieldReader reader(document);
  reader.read([&](FieldVisitor& visitor) { visit_tests(visitor, reading.tests); });
  DataReader data(file.parent_path(), reader);
  data.read(reading.tests);
  reading.errors.insert(reading.errors.end(), reader.errors().begin(), reader.errors().end());
  document.sort(reading.errors);
  reading.errors.insert(reading.errors.end(), data.errors().begin(), data.errors().end());
  return reading;
}

}  // namespace drapeplan
