#include "planner/schedule/motion_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "planner/base/spelling.hpp"
#include "planner/base/text.hpp"
#include "planner/schedule/motion.hpp"
#include "planner/schedule/robot_files.hpp"
#include "planner/tables/table_text.hpp"

namespace drapeplan {
namespace {

constexpr size_t kMostErrors = 100;    // one fault may be in every row
constexpr double kFarthest = 100;      // [m], of a place
constexpr double kLongest = 3600;      // [s], of a motion
constexpr double kLeastStep = 0.5e-6;  // [s], from row to row: times in our files are whole microseconds
/// Heights and integrated velocities of one motion differ by less than this share of the way, and this [m].
constexpr double kVelocityShare = 0.1, kVelocitySlack = 1e-3;

constexpr std::array kOfGripper{MotionColumn::z,  MotionColumn::vz, MotionColumn::x,      MotionColumn::y,
                                MotionColumn::vx, MotionColumn::vy, MotionColumn::suction};

/// A column of the file: what it holds, and in a table with a row per instant, of which gripper.
struct Column {
  MotionColumn holds = MotionColumn::time;
  std::optional<int> gripper;
  std::string name;
};

bool is_in_plane(MotionColumn column) {
  return column == MotionColumn::x || column == MotionColumn::y || column == MotionColumn::vx ||
         column == MotionColumn::vy;
}

/// What was read of one gripper, column by column, with the lines of the rows.
struct Rows {
  std::map<MotionColumn, std::vector<double>> values;
  std::vector<int> lines;

  std::vector<double>& operator[](MotionColumn column) { return values[column]; }
};

std::vector<Eigen::Vector2d> pairs(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<Eigen::Vector2d> result;
  for (size_t k = 0; k < std::min(x.size(), y.size()); ++k) result.emplace_back(x[k], y[k]);
  return result;
}

class MotionReader {
 public:
  MotionReader(const std::filesystem::path& file, const RigOptions& rig)
      : file_(file), rig_(rig), rows_(size_t(rig.count())) {}

  ScheduleReading read() {
    std::string text;
    std::optional<InputError> fault = load_table_text(file_, text);
    if (fault) {
      reading_.errors.push_back(std::move(*fault));
      return std::move(reading_);
    }
    read_text(text);
    if (reading_.errors.empty()) check_motions();
    if (reading_.errors.empty()) reading_.value = schedule_through(motions());
    if (left_out_ > 0)
      reading_.errors.push_back(
          {file_.string(), names_line_, "", fmt::format("and {} further errors", left_out_)});
    return std::move(reading_);
  }

 private:
  bool fail(int line, const std::string& column, std::string message) {
    if (reading_.errors.size() < kMostErrors)
      reading_.errors.push_back({file_.string(), line, column, std::move(message)});
    else
      ++left_out_;
    return false;
  }

  [[nodiscard]] bool driven_in_plane() const { return rig_.driven == Driven::xyz; }

  [[nodiscard]] std::string rig_text() const {
    return fmt::format("the rig has grippers {} to {}", rig_.name(0), rig_.name(rig_.count() - 1));
  }

  void read_text(const std::string& text) {
    add_known();
    const size_t most = 2 * known_.size();
    split_table(text, separator_of(text), most, [&](TableLine&& line) {
      if (line.cells.front().starts_with('#')) return true;
      if (columns_.empty()) return read_names(line);
      read_row(line);
      return true;
    });
    if (columns_.empty() && reading_.errors.empty()) fail(1, "", "has comments only");
    if (!text.ends_with('\n'))
      fail(1 + int(std::count(text.begin(), text.end(), '\n')), "",
           "the last line does not end: the file may be cut off; if it is whole, add an end of line");
  }

  /// Semicolons and tabs separate where the names of the columns have them.
  static char separator_of(const std::string& text) {
    const size_t found = text.find(column_name(MotionColumn::time));
    if (found == std::string::npos) return ',';
    const size_t begin = text.rfind('\n', found) + 1;  // npos + 1 is 0
    const std::string_view line = std::string_view(text).substr(begin, text.find('\n', found) - begin);
    for (const char separator : {';', '\t'}) {
      if (line.find(separator) != std::string_view::npos) return separator;
    }
    return ',';
  }

  /// The names that a table for this rig may have, of both kinds.
  void add_known() {
    const auto add = [this](MotionColumn holds, std::optional<int> gripper) {
      const std::string name = gripper ? column_name(holds, rig_.indices(*gripper)) : column_name(holds);
      known_.emplace(name, Column{holds, gripper, name});
    };
    for (const MotionColumn holds : {MotionColumn::gripper_i, MotionColumn::gripper_j, MotionColumn::time})
      add(holds, std::nullopt);
    for (const MotionColumn holds : kOfGripper) {
      add(holds, std::nullopt);
      for (int g = 0; g < rig_.count(); ++g) add(holds, g);
    }
  }

  /// @return whether rows can be read.
  bool read_names(const TableLine& line) {
    names_line_ = line.number;
    std::vector<std::string> names;
    for (const auto& known : known_) names.push_back(known.first);
    std::set<std::string> seen;
    for (const std::string& cell : line.cells) {
      const auto found = known_.find(cell);
      if (found == known_.end()) {
        const std::string nearest = nearest_word(cell, names);
        fail(line.number, shown(cell),
             fmt::format("unknown column{} ({})",
                         nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest), rig_text()));
        columns_.emplace_back();
        continue;
      }
      if (!seen.insert(cell).second) fail(line.number, cell, "this column appears twice");
      if (is_in_plane(found->second.holds) && !driven_in_plane())
        fail(line.number, cell, "belongs to rigs that drive x and y (\"grippers.driven\": \"xyz\") only");
      columns_.push_back(found->second);
    }
    for (const MotionColumn one : {MotionColumn::gripper_i, MotionColumn::gripper_j, MotionColumn::z})
      long_ = long_ || seen.contains(column_name(one));
    add_missing(seen);
    return reading_.errors.empty();
  }

  void add_missing(const std::set<std::string>& seen) {
    std::vector<std::string> missing;
    const auto need = [&](MotionColumn column, std::optional<int> gripper) {
      const std::string name = gripper ? column_name(column, rig_.indices(*gripper)) : column_name(column);
      if (!seen.contains(name)) missing.push_back(name);
    };
    std::vector<MotionColumn> places{MotionColumn::z};
    if (driven_in_plane()) places.insert(places.end(), {MotionColumn::x, MotionColumn::y});
    need(MotionColumn::time, std::nullopt);
    if (long_) {
      need(MotionColumn::gripper_i, std::nullopt);
      need(MotionColumn::gripper_j, std::nullopt);
    }
    for (const MotionColumn place : places) {
      if (long_) need(place, std::nullopt);
      for (int g = 0; !long_ && g < rig_.count(); ++g) need(place, g);
    }
    if (!missing.empty())
      fail(
          names_line_, "",
          fmt::format("no column{} {}; a table has a row per gripper and instant, with gripper_i, gripper_j, "
                      "time_s, z_m, or a row per instant, with time_s, z_1_1_m and so on",
                      missing.size() > 1 ? "s" : "", fmt::join(missing, ", ")));
    for (const Column& column : columns_) {
      if (!column.name.empty() && column.gripper.has_value() == long_ && column.holds > MotionColumn::time)
        fail(names_line_, column.name,
             fmt::format("belongs to a table with a row per {}instant", long_ ? "" : "gripper and "));
    }
  }

  /// The numbers of a row, in the order of the columns; empty if one of them is none.
  std::vector<double> numbers(const TableLine& line) {
    if (line.cells.size() != columns_.size()) {
      fail(line.number, "",
           fmt::format("has {} cells, but line {} names {} columns", line.cells.size(), names_line_,
                       columns_.size()));
      return {};
    }
    std::vector<double> values;
    bool good = true;
    for (size_t k = 0; k < columns_.size(); ++k) {
      const std::string& cell = line.cells[k];
      const std::optional<double> value = cell_number(cell);
      values.push_back(value.value_or(0));
      if (!value)
        good = fail(
            line.number, columns_[k].name,
            cell.empty() ? "has no number in this row" : fmt::format("\"{}\" is no number", shown(cell)));
      else if (!std::isfinite(*value))
        good = fail(line.number, columns_[k].name, fmt::format("\"{}\" is no finite number", shown(cell)));
      else
        good = is_sound(line.number, columns_[k], *value) && good;
    }
    return good ? values : std::vector<double>();
  }

  bool is_sound(int line, const Column& column, double value) {
    const bool place =
        column.holds == MotionColumn::z || column.holds == MotionColumn::x || column.holds == MotionColumn::y;
    if (place && std::abs(value) > kFarthest)
      return fail(line, column.name,
                  fmt::format("{:g} m: farther than {:g} m; is it in mm?", value, kFarthest));
    if (column.holds == MotionColumn::suction && value != 0 && value != 1)
      return fail(line, column.name, fmt::format("{:g}: expected 1 (on) or 0 (off)", value));
    return true;
  }

  void read_row(const TableLine& line) {
    const std::vector<double> values = numbers(line);
    if (values.empty()) return;
    const auto value_of = [&](MotionColumn holds) {
      const auto found = std::find_if(columns_.begin(), columns_.end(),
                                      [&](const Column& column) { return column.holds == holds; });
      return values[size_t(found - columns_.begin())];
    };
    const double time = value_of(MotionColumn::time);
    if (!long_) {
      for (int g = 0; g < rig_.count(); ++g) {
        if (!add_row(line.number, g, time)) return;  // the others have the same time
      }
    }
    int gripper = 0;
    if (long_) {
      const double i = value_of(MotionColumn::gripper_i), j = value_of(MotionColumn::gripper_j);
      const bool there =
          i == std::floor(i) && j == std::floor(j) && i >= 1 && i <= rig_.columns && j >= 1 && j <= rig_.rows;
      if (!there) {
        fail(line.number, "gripper_i, gripper_j",
             fmt::format("there is no gripper [{:g}, {:g}]; {}", i, j, rig_text()));
        return;
      }
      gripper = rig_.gripper_at({int(i), int(j)});
      if (!add_row(line.number, gripper, time)) return;
    }
    for (size_t k = 0; k < columns_.size(); ++k) {
      if (columns_[k].holds > MotionColumn::time)
        rows_[size_t(columns_[k].gripper.value_or(gripper))][columns_[k].holds].push_back(values[k]);
    }
  }

  /// Begins a row of a gripper. Times increase.
  bool add_row(int line, int gripper, double time) {
    Rows& rows = rows_[size_t(gripper)];
    std::vector<double>& times = rows[MotionColumn::time];
    const std::string name = column_name(MotionColumn::time);
    if (!times.empty() && !(time >= times.back() + kLeastStep))
      return fail(line, name,
                  fmt::format("{:.15g}: times must increase; {} was at {:.15g} before", time,
                              rig_.name(gripper), times.back()));
    if (!times.empty() && time - times.front() > kLongest && rows.lines.size() > 0 && !too_long_) {
      too_long_ = true;
      return fail(line, name,
                  fmt::format("{:g} s after the first row: longer than {:g} s; is it in ms?",
                              time - times.front(), kLongest));
    }
    times.push_back(time);
    rows.lines.push_back(line);
    return true;
  }

  /// What no single row shows.
  void check_motions() {
    std::string missing;
    for (int g = 0; g < rig_.count(); ++g) {
      if (rows_[size_t(g)].lines.empty()) missing += ' ' + rig_.name(g);
    }
    if (!missing.empty()) fail(names_line_, "", "no row for gripper" + missing);
    if (!missing.empty()) return;
    for (int g = 0; g < rig_.count(); ++g) {
      check_suction(g);
      check_velocities(g, MotionColumn::z, MotionColumn::vz);
      check_velocities(g, MotionColumn::x, MotionColumn::vx);
      check_velocities(g, MotionColumn::y, MotionColumn::vy);
    }
  }

  void check_suction(int gripper) {
    Rows& rows = rows_[size_t(gripper)];
    const std::vector<double>& on = rows[MotionColumn::suction];
    for (size_t k = 1; k < on.size(); ++k) {
      if (on[k] > on[k - 1])
        fail(rows.lines[k], "suction",
             fmt::format("comes back at gripper {}: the ply that it has let go is not taken again",
                         rig_.name(gripper)));
    }
  }

  /// Velocities lead from place to place, or one of both, or the time, is in another unit.
  void check_velocities(int gripper, MotionColumn place, MotionColumn velocity) {
    Rows& rows = rows_[size_t(gripper)];
    const std::vector<double>&p = rows[place], &v = rows[velocity], &t = rows[MotionColumn::time];
    if (v.empty() || p.size() != v.size()) return;
    const auto [least, most] = std::minmax_element(p.begin(), p.end());
    const double slack = kVelocityShare * (*most - *least) + kVelocitySlack;
    double integral = p.front();
    for (size_t k = 1; k < p.size(); ++k) {
      integral += 0.5 * (v[k] + v[k - 1]) * (t[k] - t[k - 1]);
      if (std::abs(integral - p[k]) <= slack) continue;
      fail(rows.lines[k], column_name(velocity),
           fmt::format("leads gripper {} to {:.4g} m, but {} says {:.4g} m: is one of them, or the time, in "
                       "another unit?",
                       rig_.name(gripper), integral, column_name(place), p[k]));
      return;
    }
  }

  std::vector<GripperMotion> motions() {
    std::vector<GripperMotion> result;
    for (Rows& rows : rows_) {
      GripperMotion motion;
      motion.time = rows[MotionColumn::time];
      motion.z = rows[MotionColumn::z];
      motion.vz = rows[MotionColumn::vz];
      motion.xy = pairs(rows[MotionColumn::x], rows[MotionColumn::y]);
      motion.v_plane = pairs(rows[MotionColumn::vx], rows[MotionColumn::vy]);
      for (const double on : rows[MotionColumn::suction]) motion.suction.push_back(on > 0);
      result.push_back(std::move(motion));
    }
    return result;
  }

  const std::filesystem::path& file_;
  const RigOptions& rig_;
  std::map<std::string, Column> known_;
  std::vector<Column> columns_;  ///< of the file; those without a name are unknown
  bool long_ = false;            ///< a row per gripper and instant, not per instant
  int names_line_ = 1;
  std::vector<Rows> rows_;
  bool too_long_ = false;
  size_t left_out_ = 0;
  ScheduleReading reading_;
};

}  // namespace

bool is_motion_file(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".csv";
}

ScheduleReading read_motion(const std::filesystem::path& file, const RigOptions& rig) {
  return MotionReader(file, rig).read();
}

}  // namespace drapeplan
