// Files that are whole or not there.
#pragma once

#include <filesystem>
#include <string_view>

namespace lightnet {

/// Writes `bytes` to a temporary file beside `path`, syncs it, and renames it to `path`. When anything goes wrong the
/// old file stays as it was, the temporary one is removed, and Error says why.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace lightnet
