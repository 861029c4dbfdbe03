#include "planner/measured/tests_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mapping/error.hpp"
#include "planner/base/quantity.hpp"
#include "planner/case/section_fields.hpp"
#include "planner/input/document.hpp"
#include "planner/input/kit.hpp"
#include "planner/input/reader.hpp"
#include "planner/measured/test_checks.hpp"

namespace drapeplan {
namespace {

/// Strain of fibres beyond which a table holds something else.
constexpr double kLargestTension = 0.2;
constexpr double kLargestStress = 2e10;  // [Pa]: no fibre bears more
constexpr double kShareOfWeight = 0.01;  // of a specimen's own weight: a force that shows nothing of it
constexpr double kLeastCellForce = 1e-3; // [N]: no load cell that holds steel shows less
constexpr double kThinnest = 1e-6;       // [m]: thinner than a fibre
constexpr double kLightest = 1e-4;       // [kg/m^2]: the lightest veils have 2e-3
constexpr double kLeastGravity = 1e-3;   // [m/s^2]: nothing bends under it
/// Simulated strips have cells of a share of their width: of longer ones nobody could wait for the end.
constexpr double kLargestSlenderness = 50;

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
  v.field({"profile", &test.profile,
           "Text table of the strip's shape at rest, from the clamp to the tip: distances x from the clamp and "
           "deflections there, relative to this file"});
  v.section({"columns", "What columns of the file are called, where that is not usual", false, {}, true}, true,
            [&] {
              v.field({"time", &test.columns.time, "Name of the column of times"});
              v.field({"deflection", &test.columns.deflection, "Name of the column of deflections"});
              v.field({"distance", &test.columns.distance, "Of a profile: name of the column of distances"});
            });
  v.list(object_list("frames", "Pictures instead of tables, in the order of time", test.frames,
                     [&v](StripFrame& frame) {
                       v.field({"file", &frame.file, "PNG, PGM, PPM or JPEG, relative to this file",
                                Dimension::none, {}, true});
                       v.field({"time", &frame.time, "Since the strip was let go", Dimension::time,
                              from(0, kLongestTest), true});
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
  v.field({"thickness", &tests.thickness, "Of the ply", Dimension::length, from(kThinnest, 0.05), true});
  v.field({"areal_density", &tests.areal_density, "Mass per area", Dimension::areal_density,
           from(kLightest, 100), true});
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
  v.field({"gravity", &tests.gravity, "Acceleration of the cantilevers", Dimension::acceleration,
           from(kLeastGravity, 100)});
  v.field({"section_points", &tests.section_points,
           "Of simulated cantilevers, 3 or 5: those of the cases that will use the material (`fem.section_points`). "
           "Three see so little of a compression curve with a break that a strip of 150 mm drops 7 mm deeper",
           Dimension::none, {3, 5, false, false, true}});
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
    for (size_t k = 0; k < tests.compliance.size(); ++k) {
      MachineLimits limits;
      limits.least_force = kLeastCellForce;
      limits.rises = true;
      table(tests.compliance[k], fmt::format("/compliance/{}", k), false, limits);
    }
    for (size_t k = 0; k < tests.tension.size(); ++k) {
      const StripTest& test = tests.tension[k];
      const std::string pointer = fmt::format("/tension/{}", k);
      check_slenderness(pointer, "height", test.height, test.width);
      MachineLimits limits = limits_of(tests, test.width, test.height, test.rate);
      limits.way = kLargestTension * test.height;
      limits.rises = true;
      table(tests.tension[k], pointer, false, limits);
    }
    for (size_t k = 0; k < tests.bias_extension.size(); ++k) {
      const std::string pointer = fmt::format("/bias_extension/{}", k);
      const StripTest& test = tests.bias_extension[k];
      const bool sizes = reader_.good(pointer + "/width") && reader_.good(pointer + "/height");
      if (sizes && !(test.height >= 2 * test.width))
        reader_.fail(pointer + "/height",
                     fmt::format("is less than twice the width ({}): no zone of the strip is then free of both "
                                 "clamps, and Eq. (10) does not hold",
                                 format_quantity(test.width, Dimension::length)));
      check_slenderness(pointer, "height", test.height, test.width);
      MachineLimits limits = limits_of(tests, test.width, test.height, test.rate);
      limits.way = (std::numbers::sqrt2 - 1) * (test.height - test.width);
      table(tests.bias_extension[k], pointer, true, limits);
    }
    for (size_t k = 0; k < tests.picture_frame.size(); ++k) {
      const FrameTest& test = tests.picture_frame[k];
      const double side = test.specimen.value_or(test.side);
      MachineLimits limits = limits_of(tests, side, side, test.rate);
      limits.way = (2 - std::numbers::sqrt2) * test.side;
      table(tests.picture_frame[k], fmt::format("/picture_frame/{}", k), true, limits);
    }
    for (size_t k = 0; k < tests.cantilever.size(); ++k)
      cantilever(tests.cantilever[k], fmt::format("/cantilever/{}", k));
    const bool any = !tests.cantilever.empty() || !tests.tension.empty() || !tests.bias_extension.empty() ||
                     !tests.picture_frame.empty();
    if (!any && reader_.errors().empty()) reader_.add_error("", "names no tests");
  }

  [[nodiscard]] std::vector<InputError>& errors() { return errors_; }

 private:
  /// Of a specimen: forces between a share of its weight and what fibres bear.
  [[nodiscard]] static MachineLimits limits_of(const Tests& tests, double width, double height, double rate) {
    MachineLimits limits;
    limits.rate = rate;
    limits.least_force = kShareOfWeight * tests.gravity * tests.areal_density * width * height;
    limits.most_force = kLargestStress * width * tests.thickness;
    return limits;
  }

  void check_slenderness(const std::string& pointer, const std::string& name, double length, double width) {
    if (reader_.good(pointer + "/width") && reader_.good(pointer + '/' + name) && length > kLargestSlenderness * width)
      reader_.fail(pointer + "/width", fmt::format("is less than {:g} of the {} ({}): the wrong unit?",
                                                   1 / kLargestSlenderness, name,
                                                   format_quantity(length, Dimension::length)));
  }

  /// @param angle  whether shear angles may have been measured.
  template <class Test>
  void table(Test& test, const std::string& pointer, bool angle, const MachineLimits& limits) {
    if (!reader_.good(pointer + "/file")) return;
    std::vector<WantedColumn> wanted{{TestQuantity::time, false, test.columns.time},
                                     {TestQuantity::displacement, true, test.columns.displacement},
                                     {TestQuantity::force, true, test.columns.force}};
    if (angle) wanted.push_back({TestQuantity::angle, false, test.columns.angle});
    for (WantedColumn& column : wanted) column.required = column.required || !column.header.empty();
    const bool sizes = reader_.good(pointer) && reader_.good("/thickness") && reader_.good("/areal_density");
    test.table = read(test.file, wanted, kFewestTestRows, [&](const TestTable& rows, const std::string& file) {
      return sizes ? machine_faults(rows, file, limits) : std::vector<InputError>();
    });
  }

  /// Reads a table, and looks for faults of it as a whole.
  template <class Faults>
  TestTable read(const std::string& name, const std::vector<WantedColumn>& wanted, size_t fewest,
                 const Faults& faults) {
    TableReading reading = read_test_table(folder_ / name, wanted, fewest);
    if (reading.errors.empty()) reading.errors = faults(reading.table, (folder_ / name).string());
    errors_.insert(errors_.end(), reading.errors.begin(), reading.errors.end());
    return std::move(reading.table);
  }

  void cantilever(CantileverTest& test, const std::string& pointer) {
    if (!reader_.good(pointer)) return;
    check_slenderness(pointer, "length", test.length, test.width);
    if (int(!test.file.empty()) + int(!test.profile.empty()) + int(!test.frames.empty()) != 1)
      return reader_.add_error(pointer, "needs one of three: a file with the deflections of its tip, frames, or a "
                                        "profile");
    const WantedColumn deflection{TestQuantity::deflection, true, test.columns.deflection};
    if (!test.file.empty())
      test.table = read(test.file, {{TestQuantity::time, true, test.columns.time}, deflection}, kFewestTestRows,
                        [&](const TestTable& rows, const std::string& file) {
                          return drop_faults(rows, file, test.length);
                        });
    if (!test.profile.empty())
      test.table = read(test.profile, {{TestQuantity::distance, true, test.columns.distance}, deflection},
                        kFewestProfileRows, [&](const TestTable& rows, const std::string& file) {
                          return profile_faults(rows, file, test.length);
                        });
    if (test.frames.empty()) return;
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
      if (std::abs(length - test.length) > kLengthTolerance * test.length)
        throw WrongInput(fmt::format("the strip is {:.4g} mm long, not {:.4g} mm: the wrong scale, threshold or "
                                     "clamp",
                                     1e3 * length, 1e3 * test.length));
      constexpr double kAbove = 0.02;  // of the length
      if (one.line.back().y() > kAbove * test.length)
        throw WrongInput("the strip ends above its clamp: is the clamp on the other side (`clamp_right`)?");
      const double drop = -one.line.back().y();
      if (k + 1 == test.frames.size() && !(drop >= kLeastDrop * test.length))
        throw WrongInput(fmt::format("the strip drops by {:.3g} mm, less than {:g} % of its length: too little to be "
                                     "measured",
                                     1e3 * drop, 1e2 * kLeastDrop));
    } catch (const WrongInput& error) {
      const std::string reason = error.what();
      errors_.push_back({file, 0, "", reason.starts_with(file) ? reason.substr(file.size() + 2) : reason});
    }
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
  if (reading.tests.assumed) read_curve_files(*reading.tests.assumed, "/assumed", reader);
  DataReader data(file.parent_path(), reader);
  data.read(reading.tests);
  reading.errors.insert(reading.errors.end(), reader.errors().begin(), reader.errors().end());
  document.sort(reading.errors);
  reading.errors.insert(reading.errors.end(), data.errors().begin(), data.errors().end());
  return reading;
}

}  // namespace drapeplan
