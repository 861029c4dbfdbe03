// Cases whose mold is a file: the article's mold as polynomial, as triangles and as heights is the same mold.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "planner/case/file.hpp"
#include "planner/drape/problem.hpp"
#include "planner/search/plan.hpp"
#include "tests/mapping/molds.hpp"
#include "tests/mapping/surface/meshes.hpp"
#include "tests/planner/molds/kit.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

/// The article's mold in millimetres.
Triangles article_mesh(int n) {
  const Mold mold = article_mold();
  Triangles mesh = triangulated([&](double x, double y) { return mold.height(x, y); }, mold.extent(), n, n);
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex *= 1e3;
  return mesh;
}

CaseReading read_with(const ScratchFolder& folder, const json& mold) {
  std::ifstream shipped(DRAPEPLAN_SOURCE_DIR "/cases/flexdraper-quick.json");
  json root = json::parse(shipped);
  root["material"] = DRAPEPLAN_SOURCE_DIR "/cases/" + root["material"].get<std::string>();
  root["mold"] = mold;
  return read_case(folder.write("case.json", root.dump(1)));
}

Case good_case(const ScratchFolder& folder, const json& mold) {
  CaseReading reading = read_with(folder, mold);
  for (const InputError& error : reading.errors) ADD_FAILURE() << error.text();
  return std::move(reading.definition);
}

void expect_error(const CaseReading& reading, const std::string& part) {
  for (const InputError& error : reading.errors) {
    if (error.text().find(part) != std::string::npos) return;
  }
  ADD_FAILURE() << "no error says \"" << part
                << "\": " << (reading.errors.empty() ? "there is none" : reading.errors.front().text());
}

TEST(MoldOfAFile, IsReadBesideTheCaseAndSaysHowWellItIsMet) {
  const ScratchFolder folder;
  folder.write("data/mold.stl", binary_stl(solid(article_mesh(30), -100)));
  const CaseReading reading = read_with(folder, {{"shape", "stl"}, {"file", "data/mold.stl"}});
  ASSERT_TRUE(reading.errors.empty()) << reading.errors.front().text();
  ASSERT_EQ(reading.notes.size(), 1u);
  EXPECT_NE(reading.notes[0].find("/mold: data/mold.stl: "), std::string::npos) << reading.notes[0];
  EXPECT_NE(reading.notes[0].find("961 vertices seen from above"), std::string::npos) << reading.notes[0];
  const Mold exact = article_mold(), &mold = *reading.definition.mold;
  EXPECT_NEAR(mold.extent().upper.y(), 0.45, 1e-7);
  for (double x = 0.01; x < 0.45; x += 0.03) EXPECT_NEAR(mold.height(x, 0.2), exact.height(x, 0.2), 2e-5);
}

TEST(MoldOfAFile, IsTurnedThenMoved) {
  const ScratchFolder folder;
  Triangles mesh = article_mesh(30);
  for (Eigen::Vector3d& v : mesh.vertices)
    v = 1e-3 * Eigen::Vector3d(v.y() - 100, -v.x() - 50, v.z() + 7);  // [m]
  folder.write("turned.obj", obj(mesh));
  const Case definition = good_case(folder, {{"shape", "stl"},
                                             {"file", "turned.obj"},
                                             {"unit", "1 m"},
                                             {"rotate", {"0 deg", "0 deg", "90 deg"}},
                                             {"translate", {"-50 mm", "100 mm", "-7 mm"}}});
  const Mold exact = article_mold();
  for (double x = 0.01; x < 0.45; x += 0.03)
    EXPECT_NEAR(definition.mold->height(x, 0.2), exact.height(x, 0.2), 2e-5);
}

TEST(MoldOfAFile, IsWrittenOutAndReadAgainToTheBitWithoutItsFile) {
  const ScratchFolder folder, elsewhere;
  const auto stl = folder.write("mold.stl", binary_stl(article_mesh(24)));
  const Case first = good_case(folder, {{"shape", "stl"}, {"file", "mold.stl"}});
  const json resolved = resolved_case(first);
  EXPECT_EQ(resolved.at("/mold/shape"_json_pointer), "spline");
  const CaseReading again = read_case(elsewhere.write("resolved.json", resolved.dump(2)));
  ASSERT_TRUE(again.errors.empty()) << again.errors.front().text();
  EXPECT_EQ(resolved_case(again.definition), resolved);
  const auto& a = std::get<SplineShape>(first.mold->shape());
  const auto& b = std::get<SplineShape>(again.definition.mold->shape());
  EXPECT_TRUE(a.coefficients == b.coefficients && a.origin == b.origin && a.spacing == b.spacing);
  json damaged = resolved;
  damaged["mold"]["rows"] = 7;
  expect_error(read_case(elsewhere.write("damaged.json", damaged.dump(2))), "is no base64 of");
}

TEST(MoldOfAFile, TheHashOfACaseIsThatOfItsContentNotOfItsName) {
  const ScratchFolder folder;
  const Triangles mesh = article_mesh(24);
  folder.write("mold.stl", binary_stl(mesh));
  folder.write("deeper/other.stl", binary_stl(mesh));
  Triangles bent = mesh;
  bent.vertices[300].z() += 0.5;
  folder.write("bent.stl", binary_stl(bent));
  const auto hash = [&](const char* file) {
    return case_hash(good_case(folder, {{"shape", "stl"}, {"file", file}}));
  };
  EXPECT_EQ(hash("mold.stl"), hash("deeper/other.stl"));
  EXPECT_NE(hash("mold.stl"), hash("bent.stl"));
}

TEST(MoldOfAFile, FaultsNameTheFileAndThePlace) {
  const ScratchFolder folder;
  const Triangles mesh = article_mesh(30);
  folder.write("mold.stl", binary_stl(mesh));
  const auto with = [&](json mold) {
    mold["shape"] = "stl";
    if (!mold.contains("file")) mold["file"] = "mold.stl";
    return read_with(folder, mold);
  };
  const auto square = [](const char* lower, const char* upper) {
    return json::array({json::array({lower, upper}), json::array({lower, upper})});
  };
  expect_error(with({{"file", "nowhere.stl"}}), "nowhere.stl: cannot be read");
  expect_error(with({{"unit", "1 um"}}), "is \"unit\", 0.001 mm, wrong?");
  expect_error(with({{"unit", "1 m"}}), "is \"unit\", 1000 mm, wrong?");
  expect_error(with({{"extent", square("0 mm", "500 mm")}}), "which is not all of the extent");
  expect_error(with({{"angle", "3 deg"}}), "belongs to");
  Triangles hole = mesh;
  const int at = 2 * (20 * 30 + 10);  // the rectangle from x = 300 mm, y = 150 mm
  hole.corners.erase(hole.corners.begin() + at, hole.corners.begin() + at + 2);
  folder.write("hole.stl", binary_stl(hole));
  expect_error(with({{"file", "hole.stl"}}), "there is no surface at x = 30");
  EXPECT_TRUE(with({{"file", "mold.stl"}, {"extent", square("5 mm", "445 mm")}}).errors.empty());
  expect_error(read_with(folder, {{"shape", "stl"}}), "\"file\" is missing");
  expect_error(read_with(folder, {{"shape", "plane"}}), "\"extent\" is missing");
}

TEST(MoldOfAFile, ThePolynomialItsTrianglesAndItsHeightsAreDrapedAlike) {
  const ScratchFolder folder;
  const Triangles mesh = article_mesh(45);
  folder.write("mold.stl", text_stl(mesh));
  folder.write("mold.csv", points_csv(mesh));
  std::ifstream shipped(DRAPEPLAN_SOURCE_DIR "/cases/flexdraper-quick.json");
  const json polynomial = json::parse(shipped).at("mold");
  std::vector<Drape> drapes;
  for (const json& mold : {polynomial, json{{"shape", "stl"}, {"file", "mold.stl"}},
                           json{{"shape", "height_field"}, {"file", "mold.csv"}}}) {
    const DrapeProblem problem(good_case(folder, mold));
    drapes.push_back(problem.run(to_schedule(problem.frame(), uniform_strokes(problem.frame())), "screen"));
    ASSERT_TRUE(drapes.back().score.valid) << drapes.back().score.reason;
  }
  for (size_t k = 1; k < drapes.size(); ++k) {
    const Score &exact = drapes[0].score, &score = drapes[k].score;
    // The surfaces differ by 3 um. A drape adds to it what disturbances of this size do to folds.
    EXPECT_NEAR(score.max_gap, exact.max_gap, 2e-4);
    EXPECT_NEAR(score.rms_gap, exact.rms_gap, 5e-5);
    EXPECT_NEAR(score.max_boundary_offset, exact.max_boundary_offset, 2e-4);
    EXPECT_NEAR(score.max_shear_deg, exact.max_shear_deg, 0.1);
  }
}

}  // namespace
}  // namespace drapeplan
