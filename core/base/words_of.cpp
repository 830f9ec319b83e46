#include "core/base/words_of.hpp"

#include <filesystem>
#include <ios>
#include <new>
#include <system_error>

#include "core/base/spare_threads.hpp"

namespace lightnet {

std::string words_of(const std::exception& error) {
    if (dynamic_cast<const std::bad_alloc*>(&error)) return "there is not enough memory";
    if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error))
        return file->path1().string() + ": " + file->code().message();
    if (const auto* stream = dynamic_cast<const std::ios_base::failure*>(&error))
        return "a file can't be read or written: " + stream->code().message();
    if (const auto* system = dynamic_cast<const std::system_error*>(&error);
        system && system->code() == std::errc::resource_unavailable_try_again)
        return std::string("the system gives no more threads; ") + more_threads_help;
    return error.what();
}

}  // namespace lightnet
