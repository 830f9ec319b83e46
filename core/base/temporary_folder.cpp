#include "core/base/temporary_folder.hpp"

#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "core/base/error.hpp"

namespace lightnet {

TemporaryFolder::TemporaryFolder(const std::string& name) {
    const char* const temporary = std::getenv("TMPDIR");
    const std::string within = temporary && *temporary ? temporary : "/tmp";
    std::string path = within + "/lightnet-" + name + "-XXXXXX";
    if (!::mkdtemp(path.data()))
        throw Error(within, std::string("no folder can be made there: ") + std::strerror(errno));
    path_ = path;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace lightnet
