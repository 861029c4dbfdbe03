// A case to start from, made for a size of ply, a mold and a grid of grippers.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace drapeplan {

/// new_case.json and cases/materials/bmi-4hs.json as texts, put into the program by CMake.
extern const char* const kNewCase;
extern const char* const kNewCaseMaterial;

/// What people say of the case that they want.
struct NewCase {
  double width = 0.4, height = 0.3;  ///< of the ply [m]
  int columns = 0, rows = 0;         ///< of grippers; 0: as many as suit the ply
  /// polynomial, sphere, or a file: stl (STL and OBJ) or height_field.
  std::string mold = "polynomial";
  std::filesystem::path mold_file;
  std::string unit = "1 mm";  ///< what 1 in that file stands for
};

/// The case, keys in the order in which people read them. A mold from a file lies below its middle.
/// @param folder  in which the case will lie: the mold's file is named relative to it.
/// @throws WrongInput if pads of this ply would touch each other, or the mold's file is none.
nlohmann::ordered_json new_case(const NewCase& wanted, const std::filesystem::path& folder);

/// The text of a case: lists of numbers and texts on one line.
std::string case_text(const nlohmann::ordered_json& value);

}  // namespace drapeplan
