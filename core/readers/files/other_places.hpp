// Places of files that scenes name as they were called on another machine.
#pragma once

#include <string>
#include <vector>

#include "core/readers/files/files.hpp"

namespace lightnet {

/// Where else a file may be that the file `from` names, at the path that this comes to: there in other large and small
/// letters, else of its name alone beside `from`. All of them are files.
std::vector<std::string> other_places(Files& files, const std::string& from, const std::string& written);

}  // namespace lightnet
