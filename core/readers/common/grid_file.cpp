#include "core/readers/common/grid_file.hpp"

#include "core/readers/common/nanovdb_file.hpp"
#include "core/readers/common/vdb_file.hpp"

namespace lightnet {

std::vector<std::string> names_of_grids(std::span<const std::byte> bytes) {
    return is_vdb(bytes) ? names_in_vdb(bytes) : names_in_nanovdb(bytes);
}

std::optional<SparseGrid> read_grid(std::span<const std::byte> bytes, std::string_view name) {
    return is_vdb(bytes) ? read_vdb(bytes, name) : read_nanovdb(bytes, name);
}

}  // namespace lightnet
