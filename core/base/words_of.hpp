// The words of an exception, for people.
#pragma once

#include <exception>
#include <string>

namespace lightnet {

/// Its own words, where it has any: what the library throws for want of memory, of threads or of files has only names
/// of classes and functions.
std::string words_of(const std::exception& error);

}  // namespace lightnet
