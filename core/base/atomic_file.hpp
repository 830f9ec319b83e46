// Files that are whole or not there.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

namespace lightnet {

/// Writes `bytes` to a temporary file beside `path`, syncs it, and renames it to `path`. When anything goes wrong the
/// old file stays as it was, the temporary one is removed, and Error says why.
void write_file(const std::filesystem::path& path, std::string_view bytes);
/// The same for what lies in pieces.
void write_file(const std::filesystem::path& path, std::span<const std::string_view> pieces);

}  // namespace lightnet
