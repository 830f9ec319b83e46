// The fingerprint by which a host proves that it computes as we do: by behaviour.
#pragma once

#include <cstdint>
#include <string>

namespace lightnet {

/// A hash over the answers of some thousands of rays against a small scene, with this instruction set of Embree, and
/// over some thousands of calls of the mathematical library. Two hosts whose fingerprints differ would give pictures
/// that differ in their last bits. Computed once for each instruction set: whoever asks often costs nothing. Throws
/// Error when the processor lacks the instruction set. Any thread.
std::uint64_t fingerprint(const std::string& isa);

/// The fastest instruction set that hosts are likely to share: "avx2" where the processor has it, else "sse4.2".
std::string usual_isa();

}  // namespace lightnet
