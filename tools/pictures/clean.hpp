// Pictures that noise is taken out of, as files.
#pragma once

#include <string>

namespace lightnet {

/// x.exr → x.clean.exr
std::string clean_beside(const std::string& exr);

}  // namespace lightnet
