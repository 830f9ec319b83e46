#include "core/readers/files/other_places.hpp"

#include <algorithm>

namespace lightnet {

std::vector<std::string> other_places(Files& files, const std::string& from, const std::string& written) {
    const std::string alone = beside(from, written.substr(written.find_last_of('/') + 1));
    std::vector<std::string> places;
    // read at once, so that hosts are sent what was found, and find it again
    const auto add = [&](const std::string& path) {
        try {
            if (path != written && std::ranges::find(places, path) == places.end() && files.read(path))
                places.push_back(path);
        } catch (const MissingHere&) {
            throw;
        } catch (const Error&) {  // it is not there either
        }
    };
    if (const auto found = files.like(written)) add(*found);
    add(alone);
    if (const auto found = files.like(alone)) add(*found);
    return places;
}

}  // namespace lightnet
