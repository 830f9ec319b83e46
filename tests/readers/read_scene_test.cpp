// A scene format is one folder and one line in a table.
#include "core/readers/read_scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/support/memory_files.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::read_scene_test {
namespace {

using testing::HasSubstr;

/// A format of one word per file, the name of its only object.
SceneData read_word(Files& files, const std::string& path, const SceneConstants& constants) {
    SceneData scene;
    const Bytes bytes = files.read(path);
    for (const std::byte byte : *bytes) scene.objects.resize(1), scene.objects[0].name += static_cast<char>(byte);
    for (const auto& [name, value] : constants) scene.objects[0].name += " " + name + "=" + value;
    return scene;
}

const std::vector<SceneFormat> of_words{
    {.endings = {".word", ".wd"}, .read = read_word},
    {.endings = {".w"}, .maker = "Somebody", .has_variables = true, .read = read_word}};

std::string object_in(const std::string& path, const SceneConstants& constants = {}) {
    test::MemoryFiles files{{path, "chair"}};
    return read_scene(files, path, constants, of_words).objects.at(0).name;
}

std::string refusal_of(const std::string& path, const SceneConstants& constants = {}) {
    try {
        object_in(path, constants);
        return "no error";
    } catch (const UserError& error) {
        return error.what();
    }
}

TEST(SceneFormats, AreToldByAnyOfTheirEndings) {
    EXPECT_EQ(object_in("a.word"), "chair");
    EXPECT_EQ(object_in("folder.pbrt/A.WD"), "chair");
    EXPECT_THAT(refusal_of("a.pbrt"), HasSubstr("a scene must be a '.word', '.wd' or '.w' (Somebody) file"));
}

TEST(SceneFormats, GetConstantsWhereTheyHaveVariables) {
    EXPECT_EQ(object_in("a.w", {{"size", "2"}}), "chair size=2");
    EXPECT_THAT(refusal_of("a.word", {{"size", "2"}}),
                HasSubstr("only Somebody's scenes ('.w') have variables: there is no 'size' to define"));
}

TEST(SceneFormats, ThatThereAreHaveEndingsOfTheirOwn) {
    std::multiset<std::string> endings;
    for (const SceneFormat& format : scene_formats()) {
        EXPECT_TRUE(format.read && !format.endings.empty());
        endings.insert(format.endings.begin(), format.endings.end());
    }
    for (const auto& ending : endings) {
        EXPECT_EQ(endings.count(ending), 1u) << ending;
        EXPECT_TRUE(is_named_like_a_scene("scene" + ending));
    }
    EXPECT_FALSE(is_named_like_a_scene("scene.word"));
}

TEST(SceneFormats, ComeFromPluginsToo) {
    EXPECT_FALSE(is_named_like_a_scene("a.plugged"));
    add_scene_formats({{.endings = {".plugged"}, .read = read_word, .plugin = "words 1.0 (aa)"}});
    ASSERT_TRUE(scene_format_of("a.plugged"));
    EXPECT_EQ(scene_format_of("a.plugged")->plugin, "words 1.0 (aa)");
    EXPECT_EQ(scene_format_of("a.pbrt")->plugin, "");
    const auto refused = [](const SceneFormat& format) -> std::string {
        try {
            add_scene_formats({{.endings = {".unheard"}, .read = read_word}, format});
        } catch (const Error& error) {
            EXPECT_FALSE(is_named_like_a_scene("a.unheard")) << "all or none";
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(refused({.endings = {".ply"}, .read = read_word}), HasSubstr("'.ply', which lightnet reads already"));
    EXPECT_THAT(refused({.endings = {".plugged"}, .read = read_word}),
                HasSubstr("'.plugged', which words 1.0 (aa) has brought already"));
    EXPECT_THAT(refused({.endings = {".Big"}, .read = read_word}), HasSubstr("no large letters"));
    EXPECT_THAT(refused({.endings = {"dotless"}, .read = read_word}), HasSubstr("an ending has a dot"));
    EXPECT_THAT(refused({.endings = {}, .read = read_word}), HasSubstr("no ending"));
    EXPECT_THAT(refused({.endings = {".unread"}}), HasSubstr("no ending or reader"));
}

// By all readers alike, at once, and not only when the scene is built.
TEST(ReadScene, RefusesMixturesThatAreTooDeep) {
    std::string text = "MakeNamedMaterial \"m0\" \"string type\" \"diffuse\"\n";
    for (int i = 1; i < 70; ++i)
        text += "MakeNamedMaterial \"m" + std::to_string(i) + "\" \"string type\" \"mix\" \"string materials\" [\"m" +
                std::to_string(i - 1) + "\" \"m0\"]\n";
    text += "NamedMaterial \"m69\"\nShape \"sphere\"\n";
    EXPECT_THAT(test::errors_as("deep.pbrt", "WorldBegin\n" + text), HasSubstr("more than 64 deep"));
}

}  // namespace
}  // namespace lightnet::read_scene_test
