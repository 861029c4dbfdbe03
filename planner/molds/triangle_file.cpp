#include "planner/molds/triangle_file.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
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

void append(const aiMesh& mesh, Triangles& triangles) {
  const int first = int(triangles.vertices.size());
  for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
    const aiVector3D& v = mesh.mVertices[k];
    triangles.vertices.emplace_back(double(v.x), double(v.y), double(v.z));
  }
  for (unsigned k = 0; k < mesh.mNumFaces; ++k) {
    const aiFace& face = mesh.mFaces[k];
    if (face.mNumIndices != 3) continue;  // points and lines
    triangles.corners.push_back(
        {first + int(face.mIndices[0]), first + int(face.mIndices[1]), first + int(face.mIndices[2])});
  }
}

}  // namespace

TriangleReading read_triangles(const std::filesystem::path& file) {
  TriangleReading reading;
  const auto fail = [&](const std::string& message) {
    reading.errors.push_back({file.string(), 0, "", message});
    return reading;
  };
  const std::string ending = ending_of(file);
  if (ending != ".stl" && ending != ".obj" && ending != ".ply")
    return fail("the ending of its name says what it is; expected .stl, .obj or .ply");
  const FileText content = read_file(file);
  if (!content.fault.empty()) return fail("cannot be read: " + content.fault);
  // Read from memory: a file of triangles cannot make it open others, such as materials.
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFileFromMemory(content.text.data(), content.text.size(),
                                                     aiProcess_Triangulate, ending.c_str() + 1);
  if (scene == nullptr)
    return fail(fmt::format("is no {} file: {}", ending, shown(importer.GetErrorString())));
  for (unsigned k = 0; k < scene->mNumMeshes; ++k) append(*scene->mMeshes[k], reading.triangles);
  if (reading.triangles.corners.empty()) return fail("has no triangles");
  return reading;
}

}  // namespace drapeplan
