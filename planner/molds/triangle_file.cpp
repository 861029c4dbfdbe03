#include "planner/molds/triangle_file.hpp"

#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/Importer.hpp>
#include <cctype>
#include <string>

#include "planner/base/text.hpp"

namespace drapeplan {
namespace {

std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  for (char& letter : ending) letter = char(std::tolower(static_cast<unsigned char>(letter)));
  return ending;
}

/// @return false if a face names a vertex that there is not.
bool append(const aiMesh& mesh, Triangles& triangles) {
  const int first = int(triangles.vertices.size());
  for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
    const aiVector3D& v = mesh.mVertices[k];
    triangles.vertices.emplace_back(double(v.x), double(v.y), double(v.z));
  }
  for (unsigned k = 0; k < mesh.mNumFaces; ++k) {
    const aiFace& face = mesh.mFaces[k];
    const auto corner = [&](unsigned index) { return first + int(face.mIndices[index]); };
    for (unsigned index = 0; index < face.mNumIndices; ++index) {
      if (face.mIndices[index] >= mesh.mNumVertices) return false;
    }
    for (unsigned index = 2; index < face.mNumIndices; ++index)  // none of points and lines
      triangles.corners.push_back({corner(0), corner(index - 1), corner(index)});
  }
  return true;
}

}  // namespace

TriangleReading read_triangles(const std::filesystem::path& file) {
  TriangleReading reading;
  const auto fail = [&](const std::string& message) {
    reading.errors.push_back({file.string(), 0, "", message});
    return reading;
  };
  const std::string ending = ending_of(file);
  if (ending != ".stl" && ending != ".obj")
    return fail("the ending of its name says what it is; expected .stl or .obj");
  const FileText content = read_file(file);
  if (!content.fault.empty()) return fail("cannot be read: " + content.fault);
  // PLY is not offered: Assimp's reader of it may not end where a file is damaged. Read from memory: a file
  // of triangles cannot make it open others, such as materials. Nothing is done to the faces: steps that
  // Assimp offers for it end the program where a damaged file has faces without corners.
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFileFromMemory(content.text.data(), content.text.size(), 0, ending.c_str() + 1);
  if (scene == nullptr)
    return fail(fmt::format("is no {} file: {}", ending, shown(importer.GetErrorString())));
  for (unsigned k = 0; k < scene->mNumMeshes; ++k) {
    if (!append(*scene->mMeshes[k], reading.triangles))
      return fail("a face names a vertex that there is not");
  }
  if (reading.triangles.corners.empty()) return fail("has no triangles");
  return reading;
}

}  // namespace drapeplan
