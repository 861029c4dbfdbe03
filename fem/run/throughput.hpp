// How fast the machine and the time step are: figures for benchmarks, one core.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fem/run/simulate.hpp"

namespace drapeplan {

/// Multiplications and additions per second that the lanes of one core reach, all operands in registers; the
/// best of several short runs [1/s].
double fma_peak();

/// Bytes per second that one core reads and writes in a loop over arrays of so many bytes in all.
double stream_rate(std::size_t bytes);

/// Floating-point operations of the element kernel per element that is a rectangle, lookups and roots
/// included (an FMA is two); counted by running it.
int kernel_flops(int section_points, int fibre_points);

/// Bytes of node and element arrays that a step reads and writes, per element; what stays in caches counts
/// too.
double step_bytes(const Model& model);

/// Bytes that a scene takes, as the C library's allocator books them, its own headers included; 0 where it
/// does not tell (other than glibc, sanitizers).
struct Footprint {
  std::size_t model = 0;      ///< shared by all candidates: mesh, tables, masses, what terms keep
  std::size_t state = 0;      ///< per candidate
  std::size_t workspace = 0;  ///< per candidate
};
/// Builds the scene twice: what the allocator keeps for later is there from the first time on.
Footprint measure_footprint(const Scene& scene);

/// Throughput of whole time steps.
struct Throughput {
  double updates_per_second = 0;  ///< of elements, median of the repeats
  double spread = 0;              ///< (largest - smallest) / median of the repeats
  std::int64_t steps = 0;         ///< of each repeat
  std::uint64_t state_hash = 0;   ///< at the end of each repeat
  bool same_hash = true;          ///< all repeats ended in the same bits
};

/// What is measured: from `start` on, `repeats` times the same steps.
struct ThroughputRequest {
  const Schedule* schedule = nullptr;  ///< needed with a rig
  double duration = 0;                 ///< without a schedule [s]
  double start = 0;                    ///< the run up to it warms up [s, of the schedule]
  double seconds = 0.5;                ///< that a repeat takes, about
  std::int64_t steps = 0;              ///< of each repeat, whatever time they take; 0: what fills `seconds`
  int repeats = 5;
};

/// @throws NotFinished if the scene diverges.
Throughput measure_throughput(const Model& model, const ThroughputRequest& request);

}  // namespace drapeplan
