// Kinds of nodes and formats of scenes from shared libraries.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "core/network/graph/kind.hpp"

namespace lightnet {

/// Loads them for good and adds their kinds, and their formats to those of the process. A library whose objects can't
/// go to and fro, or that brings a kind or a format that is there already, is refused. Throws UserError that names all
/// that is wrong with any of them. Before threads are started.
void load_plugins(const std::vector<std::string>& files, Registry& registry);

/// Loads what the folder of plugins holds ($LIGHTNET_PLUGIN_FOLDER, else ~/.local/share/lightnet/plugins); what can't
/// be used is left out, and said: an old plugin must not stop a program that does without.
void load_installed_plugins(Registry& registry, std::ostream& err);

/// Daemons that this process starts load the same ($LIGHTNETD_PLUGIN). Before threads are started.
void pass_on_plugins(const std::vector<std::string>& files);

/// Where those lie; "": nowhere.
std::string plugin_folder();

}  // namespace lightnet
