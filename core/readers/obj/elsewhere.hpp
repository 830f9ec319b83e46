// Files that OBJ and MTL files name as they were called on another machine.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/readers/common/assets.hpp"

namespace lightnet::obj {

/// The library that the file `from` calls `name`: as it is written, else of another case, else of that name beside
/// `from`, which is warned of. None: there is no such file.
std::optional<std::string> find_library(const std::string& from, const std::string& name, const SourceLine& where,
                                        Assets& assets);
/// The spectral curve of that name, by the same search.
std::optional<std::string> find_curve(const std::string& from, const std::string& name, const SourceLine& where,
                                      Assets& assets);
/// The image, by the same search. Null: none can be read, and the warning says what is done `instead`.
std::shared_ptr<const Image> find_picture(const std::string& from, const std::string& name, const Encoding& encoding,
                                          const SourceLine& where, const std::string& instead, Assets& assets);

}  // namespace lightnet::obj
