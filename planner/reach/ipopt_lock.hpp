// One Ipopt at a time.
#pragma once

#include <mutex>

namespace drapeplan {

/// To be held from the construction of an IpoptApplication to its destruction: Ipopt before 3.14 calls MUMPS,
/// which is not thread-safe, without a lock of its own.
std::mutex& ipopt_mutex();

}  // namespace drapeplan
