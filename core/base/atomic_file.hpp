// Files that are whole or not there.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

namespace lightnet {

/// Writes `bytes` to a temporary file beside `path`, syncs it, and renames it to `path`. When anything goes wrong the
/// old file stays as it was, the temporary one is removed, and Error says why. Where the file system can do it, the
/// temporary file has no name before it is whole: one whose writer is killed leaves nothing.
void write_file(const std::filesystem::path& path, std::string_view bytes);
/// Writes what lies in pieces, one after the other, as write_file() writes one piece.
void write_file(const std::filesystem::path& path, std::span<const std::string_view> pieces);
/// Writes it as write_file() does, but without waiting for the disk: for what is soon replaced. After a power cut a
/// file of this name may be older, or empty.
void write_file_unsynced(const std::filesystem::path& path, std::string_view bytes);
/// Writes what nobody but this user may read (mode 0600), as write_file() does, where nothing is yet. False: something
/// is there by now, and stays.
bool write_new_secret(const std::filesystem::path& path, std::string_view bytes);

}  // namespace lightnet
