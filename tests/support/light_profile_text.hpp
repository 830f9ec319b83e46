// Light profiles, written inside a test.
#pragma once

#include <string>

namespace lightnet::test {

/// By LM-63-2002: vertical and horizontal angles, and candelas plane by plane; `type`: of photometry.
inline std::string light_profile(const std::string& counts, const std::string& numbers, int type = 1,
                                 const std::string& factors = "1 1 0") {
    return "IESNA:LM-63-2002\r\n[TEST] none\r\n[MANUFAC] a test\r\nTILT=NONE\r\n1 1000 1 " + counts + " " +
           std::to_string(type) + " 2 0 0 0\r\n" + factors + "\r\n" + numbers + "\r\n";
}

}  // namespace lightnet::test
