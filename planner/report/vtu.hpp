// Files for ParaView: the ply at one instant, the mold surface, and a collection over time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fem/core/snapshot.hpp"
#include "fem/mesh/mesh.hpp"
#include "mapping/mold.hpp"
#include "mapping/net.hpp"

namespace drapeplan {

/// Writes the ply as a VTK unstructured grid (XML, double precision, base64). Point data: `gap` [m],
/// `director` [-]; cell data: `shear` [rad], `warp_strain`, `weft_strain` [-]. An empty field is left out.
/// @param gap  per node, or empty.
/// @throws std::invalid_argument if a field fits neither nodes nor elements; std::runtime_error if writing
/// fails.
void write_vtu(const std::filesystem::path& file, const Mesh& mesh, const Snapshot& snapshot,
               const std::vector<double>& gap = {});

/// Writes the mold's extent as n-by-n points with `normal` and `gaussian_curvature` [1/m^2]; cells with a
/// corner where the mold is not defined are left out. n >= 2.
void write_mold_vtu(const std::filesystem::path& file, const Mold& mold, int n = 101);

/// One file of a collection; `file` is relative to the collection.
struct PvdEntry {
  double time = 0;  ///< [s]
  std::string file;
};

/// Writes a ParaView collection; times keep all their digits.
void write_pvd(const std::filesystem::path& file, const std::vector<PvdEntry>& entries);

/// Writes a mapped net: net.csv, one row `u,v,x,y,z,shear_deg` per node [m, deg], shear as the mean of the
/// cells around it; and net.vtu for ParaView.
void write_net(const std::filesystem::path& folder, const Net& net);

/// Writes `frames` as NAME_000.vtu ... with the collection NAME.pvd.
void write_frames(const std::filesystem::path& folder, const std::string& name, const Mesh& mesh,
                  const std::vector<Snapshot>& frames, const Mold* mold, double thickness);

}  // namespace drapeplan
