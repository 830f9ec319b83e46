// Half a picture on the disk, so that a run can be gone on with.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/bytes.hpp"
#include "core/film/film.hpp"

namespace lightnet {

/// All checkpoints begin with this.
inline constexpr std::string_view checkpoint_beginning = "lightnet checkpoint ";

/// What a film holds, and what it is a picture of: names and values ("seed" → "7") that must all be the same for a run
/// that goes on with it; it may want more samples. A value.
struct Checkpoint {
    std::map<std::string, std::string> of;
    FilmState film;
};

/// x.exr → x.exr.checkpoint
std::filesystem::path checkpoint_beside(const std::filesystem::path& picture);

/// Writes it, whole or not at all. Throws Error.
void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);
/// None: there is no such file. Throws Error when it can't be read, is none, or is damaged.
std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& path);

/// The content of such a file.
Bytes checkpoint_bytes(const Checkpoint& checkpoint);
/// Throws Error when they are none, or are damaged.
Checkpoint checkpoint_in(std::span<const std::byte> bytes);

/// What differs, in words; empty when nothing does.
std::string differences(const std::map<std::string, std::string>& theirs,
                        const std::map<std::string, std::string>& ours);

}  // namespace lightnet
