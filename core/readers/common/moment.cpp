#include "core/readers/common/moment.hpp"

#include <cstdlib>

#include "core/base/error.hpp"

namespace lightnet {

std::optional<double> take_moment(SceneConstants& constants, const std::string& path, const std::string& whose) {
    if (constants.contains(std::string(animation_constant)))
        throw UserError({path, 0}, whose + " no names, so no 'animation' can be chosen");
    const auto time = constants.extract(std::string(time_constant));
    if (!time) return std::nullopt;
    return std::strtod(time.mapped().c_str(), nullptr);  // a number, as a graph has it
}

}  // namespace lightnet
