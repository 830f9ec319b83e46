// Bytes that several may look at.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace lightnet {

/// Constant and shared: a file's content, a result. Any thread may read.
using Bytes = std::shared_ptr<const std::vector<std::byte>>;

}  // namespace lightnet
