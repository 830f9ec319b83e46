// Media in Mitsuba's files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/scene_text.hpp"

namespace lightnet::test::mitsuba_media_reader_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

std::string volume(std::uint32_t nx, std::uint32_t channels, const std::vector<float>& numbers) {
    std::string text = "VOL\3" + raw(1u) + raw(nx) + raw(1u) + raw(1u) + raw(channels);
    for (const float side : {-1.f, 0.f, 0.f, 1.f, 1.f, 1.f}) text += raw(side);
    for (const float number : numbers) text += raw(number);
    return text;
}

SceneData ball_of(const std::string& medium, MemoryFiles files = {}) {
    return read_mitsuba("<emitter type='constant'/><shape type='sphere'><bsdf type='null'/>" + medium + "</shape>",
                        std::move(files));
}

TEST(MitsubaMedia, FillTheShapesThatNameThem) {
    const auto scene = read_mitsuba(
        "<emitter type='constant'/><medium id='fog' type='homogeneous'><float name='scale' value='2'/><rgb "
        "name='sigma_t' value='1, 2, 3'/>"
        "<rgb name='albedo' value='.5, .25, 0'/><phase type='hg'><float name='g' value='.3'/></phase></medium>"
        "<shape type='sphere'><bsdf type='null'/><ref id='fog' name='interior'/></shape>"
        "<shape type='sphere'><ref id='fog' name='exterior'/></shape>"
        "<sensor type='perspective'><ref id='fog'/></sensor>");
    ASSERT_EQ(scene.media.size(), 1u);
    EXPECT_EQ(scene.media[0].extinction.value, (Rgb{2, 4, 6}));
    EXPECT_EQ(scene.media[0].albedo_at({}), (Rgb{0.5f, 0.25f, 0}));
    EXPECT_EQ(scene.media[0].phase.g, 0.3f);
    EXPECT_EQ(scene.shapes.at(0).media->inside, 0);
    EXPECT_EQ(scene.shapes.at(0).media->outside, Query::no_medium);
    EXPECT_EQ(scene.shapes.at(1).media->outside, 0);
    EXPECT_EQ(scene.around, 0);
    EXPECT_THAT(scene.warnings, IsEmpty()) << warnings_of(scene);
}

TEST(MitsubaMedia, MayBeGridsFromFiles) {
    const MemoryFiles files{{"t.vol", volume(2, 1, {1, 3})}, {"a.vol", volume(1, 3, {0.1f, 0.2f, 0.3f})}};
    const auto scene = ball_of(
        "<medium name='interior' type='heterogeneous'><float name='scale' value='5'/>"
        "<volume name='sigma_t' type='gridvolume'><string name='filename' value='t.vol'/><transform name='to_world'>"
        "<scale value='2'/></transform></volume>"
        "<volume name='albedo' type='gridvolume'><string name='filename' value='a.vol'/>"
        "<boolean name='use_grid_bbox' value='true'/></volume></medium>",
        files);
    const Medium& medium = scene.media.at(0);
    EXPECT_EQ(medium.extinction.at({0.5f, 1, 1}), (Rgb{5, 5, 5}));
    EXPECT_EQ(medium.extinction.at({1, 1, 1}), (Rgb{10, 10, 10}));
    EXPECT_EQ(medium.extinction.at({1.9f, 1, 1}), (Rgb{15, 15, 15})) << "Mitsuba's grids don't fade";
    EXPECT_EQ(medium.albedo_at({-0.5f, 0, 0}), (Rgb{0.1f, 0.2f, 0.3f}));
    EXPECT_THAT(scene.warnings, IsEmpty()) << warnings_of(scene);
    const auto even = ball_of(
        "<medium name='interior' type='heterogeneous'><volume name='sigma_t' type='constvolume'><rgb name='value' "
        "value='.5, .4, .3'/></volume></medium>");
    EXPECT_EQ(even.media.at(0).extinction.at({9, 9, 9}), (Rgb{0.5f, 0.4f, 0.3f}));
}

TEST(MitsubaMedia, HaveItsPhaseFunctions) {
    const auto phase = [](const std::string& text) {
        return ball_of("<medium name='interior' type='homogeneous'>" + text + "</medium>").media.at(0).phase;
    };
    using Law = PhaseFunction::Law;
    EXPECT_EQ(phase("").law, Law::isotropic);
    EXPECT_EQ(phase("<phase type='rayleigh'/>").law, Law::rayleigh);
    const auto table = phase("<phase type='tabphase'><string name='values' value='1, 2, 3'/></phase>");
    EXPECT_NEAR(table.density(1) / table.density(-1), 3, 1e-5);
    const auto blend = phase(
        "<phase type='blendphase'><float name='weight' value='.25'/><phase type='isotropic'/><phase type='rayleigh'/>"
        "</phase>");
    EXPECT_NEAR(blend.density(0), 0.75f / (4 * 3.14159265f) + 0.25f * 3 / (16 * 3.14159265f), 1e-5f);
}

TEST(MitsubaMedia, ThatAreBrokenAreErrors) {
    const auto errors = [](const std::string& file) {
        MemoryFiles files{{"t.vol", file}};
        return errors_of_mitsuba(
            "<shape type='sphere'><bsdf type='null'/><medium name='interior' type='heterogeneous'><volume "
            "name='sigma_t' type='gridvolume'><string name='filename' value='t.vol'/></volume></medium></shape>",
            files);
    };
    EXPECT_THAT(errors("VOL"), HasSubstr("t.vol: volume file: the file ends early"));
    EXPECT_THAT(errors(std::string(60, 'x')), HasSubstr("does not begin with 'VOL'"));
    EXPECT_THAT(errors(volume(3, 1, {1, 2})), HasSubstr("the file ends early"));
    EXPECT_THAT(errors(volume(1, 2, {1, 2})), HasSubstr("2 numbers a point are not known"));
    EXPECT_THAT(errors(volume(1, 1, {-1})), HasSubstr("negative or not finite"));
    EXPECT_THAT(errors_of_mitsuba("<shape type='sphere'><bsdf type='null'/><medium name='interior' type='homogeneous'>"
                                  "<phase type='hg'><float name='g' value='1'/></phase></medium></shape>"),
                HasSubstr("'g' of a phase function must be between -1 and 1"));
}

SceneData older_ball_of(const std::string& medium, MemoryFiles files = {}) {
    return read_as("s.xml",
                   "<scene version='0.6.0'><luminaire type='constant'/><shape type='sphere'><bsdf type='null'/>" +
                       medium + "</shape></scene>",
                   std::move(files));
}

TEST(MitsubaMedia, OfVersion6HaveADensityThatFillsItsOwnBox) {
    const std::string medium =
        "<medium name='interior' type='heterogeneous'><string name='method' value='woodcock'/><float name='scale' "
        "value='5'/><volume name='density' type='gridvolume'><string name='filename' value='t.vol'/>";
    const MemoryFiles files{{"t.vol", volume(2, 1, {1, 3})}};
    const auto scene = older_ball_of(medium + "</volume></medium>", files);
    EXPECT_EQ(scene.media.at(0).extinction.at({-0.5f, 0.5f, 0.5f}), (Rgb{5, 5, 5}));
    EXPECT_EQ(scene.media.at(0).extinction.at({0, 0.5f, 0.5f}), (Rgb{10, 10, 10}));
    EXPECT_THAT(scene.warnings, IsEmpty()) << warnings_of(scene);
    const auto moved = older_ball_of(medium +
                                         "<point name='min' x='9' y='0' z='0'/><point name='max' x='11' y='1' "
                                         "z='1'/></volume></medium>",
                                     files);
    EXPECT_EQ(moved.media.at(0).extinction.at({10, 0.5f, 0.5f}), (Rgb{10, 10, 10}));
}

TEST(MitsubaMedia, OfVersion6HaveConstantsWithoutABox) {
    const auto scene = older_ball_of(
        "<medium name='interior' type='heterogeneous'><volume name='density' type='constvolume'><float name='value' "
        "value='2'/></volume><volume name='albedo' type='constvolume'><spectrum name='value' value='.5'/></volume>"
        "</medium>");
    for (const Vec3 at : {Vec3{0.5f, 0.5f, 0.5f}, Vec3{-7, 0, 0}}) {
        EXPECT_EQ(scene.media.at(0).extinction.at(at), (Rgb{2, 2, 2}));
        EXPECT_EQ(scene.media.at(0).albedo_at(at), (Rgb{0.5f, 0.5f, 0.5f}));
    }
}

TEST(MitsubaMedia, OfVersion6ByNamesAreNotKnown) {
    const auto said = [](const std::string& more) {
        return warnings_of(older_ball_of("<medium name='interior' type='homogeneous'>" + more + "</medium>"));
    };
    EXPECT_THAT(said(""), HasSubstr("the coefficients of the medium 'skin1' are not known"));
    EXPECT_THAT(said("<string name='material' value='milk'/>"), HasSubstr("of the medium 'milk' are not known"));
    EXPECT_EQ(said("<spectrum name='sigmaA' value='1'/>"), "");
    EXPECT_THAT(ball_of("<medium name='interior' type='homogeneous'/>").warnings, IsEmpty());
}

}  // namespace
}  // namespace lightnet::test::mitsuba_media_reader_test
