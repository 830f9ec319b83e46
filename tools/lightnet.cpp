// The launcher: the one place where all rooms meet.
#include <iostream>

#include "nodes/standard_nodes.hpp"
#include "tools/launcher.hpp"
#include "transport/places/descriptors.hpp"

int main(int count, char** words) {
    lightnet::raise_descriptor_limit();
    const lightnet::Registry registry{lightnet::standard_nodes()};
    const auto run = [&](const lightnet::RunRequest& request) { return lightnet::run(request, registry); };
    return lightnet::Launcher{registry, run, std::cout, std::cerr}({words + 1, words + count});
}
