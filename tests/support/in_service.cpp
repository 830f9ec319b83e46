// in_service UNIT WRITABLE PROGRAM [WORDS…]: the program as that unit's service would have it, without systemd; only
// the folder WRITABLE can be written. A unit may be a file that a test has changed.
#include <unistd.h>

#include <exception>
#include <iostream>

#include "tests/support/service_rules.hpp"

int main(int count, char** words) try {
    if (count < 4) {
        std::cerr << "in_service UNIT WRITABLE PROGRAM [WORDS…]\n";
        return 2;
    }
    lightnet::test::ServiceRules(words[1]).apply({words[2]});
    execv(words[3], words + 3);
    std::cerr << words[3] << " can't be started\n";
    return 127;
} catch (const std::exception& error) {
    std::cerr << "in_service: " << error.what() << '\n';
    return 77;
}
