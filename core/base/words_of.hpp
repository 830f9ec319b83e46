// The words of an exception, for people.
#pragma once

#include <exception>
#include <new>
#include <string>
#include <system_error>

#include "core/base/spare_threads.hpp"

namespace lightnet {

/// Its own words, where it has any: what the library throws for want of memory or of threads has only names.
inline std::string words_of(const std::exception& error) {
    if (dynamic_cast<const std::bad_alloc*>(&error)) return "there is not enough memory";
    if (const auto* system = dynamic_cast<const std::system_error*>(&error);
        system && system->code() == std::errc::resource_unavailable_try_again)
        return std::string("the system gives no more threads; ") + more_threads_help;
    return error.what();
}

}  // namespace lightnet
