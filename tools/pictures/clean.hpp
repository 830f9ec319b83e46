// Pictures that noise is taken out of, as files.
#pragma once

#include <string>

namespace lightnet {

/// x.exr → x.clean.exr, x.npz → x.clean.npz
std::string clean_beside(const std::string& file);

}  // namespace lightnet
