// RGL's files of measured materials, and how scenes name them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/readers/common/measurements.hpp"
#include "core/readers/common/spectra.hpp"
#include "tests/support/measured_numbers.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::measured_reader_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const Vec3 out = normalize(Vec3{1, 2, 2}), in = normalize(Vec3{-1, 1, 3});

std::shared_ptr<const Measurement> read(const std::string& file) { return read_measurement(*bytes_of(file)); }

std::string problem_of(const std::string& file) {
    try {
        (void)read(file);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

/// With one field of a sound file changed.
template <class Change>
std::string changed(const std::string& name, const Change& change) {
    auto fields = tensor_fields_of(even_numbers({1, 1, 1}));
    for (auto& field : fields)
        if (field.name == name) change(field);
    return tensor_file(fields);
}

TEST(MeasuredFiles, AreReadAsTheyWereWritten) {
    for (const std::uint32_t folds : {1, 2, 4}) {
        const auto numbers = ggx_numbers(0.3f, 0.5f, {0.8f, 0.5f, 0.2f}, 8, folds);
        EXPECT_EQ(read(tensor_file_of(numbers))->content(), Measurement(numbers).content());
    }
}

TEST(MeasuredFiles, MaySayColoursBySpectra) {
    const auto grey = read(tensor_file_of(even_numbers({0.4f, 0, 0}), {360, 500, 600, 1000}))->value(out, in).value;
    EXPECT_NEAR(grey.r, 0.1f, 1e-4f);
    EXPECT_NEAR(grey.g, 0.1f, 1e-4f);
    EXPECT_NEAR(grey.b, 0.1f, 1e-4f);
}

TEST(MeasuredFiles, HaveSpectraOfSurfaces) {
    auto fields = tensor_fields_of(even_numbers({1, 0, 0}), {400, 500, 600, 700});
    const std::vector<float> spectrum{0.1f, 0.2f, 0.7f, 0.4f};
    for (auto& field : fields)
        if (field.name == "spectra") {
            field.bytes.clear();
            for (int table = 0; table < 2; ++table)
                for (const float value : spectrum)
                    for (int node = 0; node < 4; ++node) field.bytes += raw(value);
        }
    const Rgb seen = read(tensor_file(fields))->value(out, in).value * 4;
    const Rgb colour =
        surface_colour(std::vector<SpectrumPoint>{{400, 0.1f}, {500, 0.2f}, {600, 0.7f}, {700, 0.4f}}).rgb;
    EXPECT_NEAR(seen.r, colour.r, 1e-4f);
    EXPECT_NEAR(seen.g, colour.g, 1e-4f);
    EXPECT_NEAR(seen.b, colour.b, 1e-4f);
}

// by their names in order, each at a multiple of eight bytes, with fields that no renderer asks for, and as fine
TEST(MeasuredFiles, AreReadInTheLayoutOfThePublicOnes) {
    std::vector<float> wavelengths;
    for (int i = 0; i < 195; ++i) wavelengths.push_back(360 + float(i) * 640 / 194);
    const auto numbers = ggx_numbers(0.3f, 0.3f, {0.6f, 0.6f, 0.6f}, 32);
    auto fields = tensor_fields_of(numbers, wavelengths);
    fields.push_back({"sample_count", 5, {1}, raw(std::uint32_t{7})});
    fields.push_back({"valid", 1, {3, 1}, "\1\1\1"});
    fields.push_back({"half", 9, {2}, raw(std::uint16_t{0x3c00}, std::uint16_t{0x7e00})});
    std::ranges::sort(fields, {}, &TensorField::name);
    const auto found = read(tensor_file(fields, 8));
    EXPECT_TRUE(found->isotropic());
    for (const Vec3 to : {in, out, normalize(Vec3{0.2f, -0.1f, 1})}) {
        const Rgb expected = Measurement(numbers).value(out, to).value, seen = found->value(out, to).value;
        EXPECT_NEAR(seen.r, expected.r, 1e-3f * expected.r);
        EXPECT_NEAR(seen.g, expected.g, 1e-3f * expected.g);
        EXPECT_NEAR(seen.b, expected.b, 1e-3f * expected.b);
    }
}

TEST(MeasuredFiles, MaySayNothingOfFacets) {
    auto numbers = even_numbers({0.4f, 0, 0}, 2);
    numbers.times_facets = false;
    EXPECT_NEAR(read(tensor_file_of(numbers))->value(out, in).value.r, 0.4f, 1e-6f);
}

TEST(MeasuredFiles, ThatAreDamagedSayWhere) {
    const std::string sound = tensor_file_of(even_numbers({1, 1, 1}));
    EXPECT_THAT(problem_of(sound), IsEmpty());
    EXPECT_THAT(problem_of(""), HasSubstr("the file ends early"));
    EXPECT_THAT(problem_of("tensor_fool" + sound.substr(11)), HasSubstr("does not begin with 'tensor_file'"));
    EXPECT_THAT(problem_of(sound.substr(0, 12) + "\2" + sound.substr(13)), HasSubstr("version 2.0 is not known"));
    EXPECT_THAT(problem_of(sound.substr(0, sound.size() - 1)), HasSubstr("field 'rgb' reaches beyond the end"));
    EXPECT_THAT(problem_of(changed("ndf", [](auto& f) { f.type = 12; })), HasSubstr("no type of numbers 12"));
    EXPECT_THAT(problem_of(changed("ndf", [](auto& f) { f.type = 6; })), HasSubstr("field 'ndf' is not of floats"));
    EXPECT_THAT(problem_of(changed("ndf", [](auto& f) { f.shape = {4}; })),
                HasSubstr("field 'ndf' has 1 dimensions, not 2"));
    EXPECT_THAT(problem_of(changed("ndf", [](auto& f) { f.name = "fdn"; })), HasSubstr("there is no field 'ndf'"));
    EXPECT_THAT(problem_of(changed("ndf", [](auto& f) { f.shape = {1, 4}; })), HasSubstr("'ndf' has a grid of 4 by 1"));
    EXPECT_THAT(problem_of(changed("ndf", [](auto& f) { f.shape = {0, 4}; })), HasSubstr("field 'ndf' is empty"));
    EXPECT_THAT(problem_of(changed("ndf",
                                   [](auto& f) {
                                       f.shape = {std::uint64_t{1} << 62, 16};
                                   })),
                HasSubstr("reaches beyond the end"));
    EXPECT_THAT(problem_of(changed("theta_i", [](auto& f) { f.bytes = raw(1.0f, 1.0f); })),
                HasSubstr("'theta_i' do not ascend"));
    EXPECT_THAT(problem_of(changed("vndf", [](auto& f) { f.shape = {2, 1, 2, 2}; })), HasSubstr("'vndf' has not"));
    EXPECT_THAT(problem_of(changed("sigma", [](auto& f) { f.bytes = raw(1.0f, 1.0f, NAN, 1.0f); })),
                HasSubstr("a number of field 'sigma' is not finite"));
    EXPECT_THAT(problem_of(changed("jacobian", [](auto& f) { f.type = 2; })), HasSubstr("'jacobian' is not one byte"));
}

TEST(MeasuredFiles, AreMeasuredAllAroundOrAWholePartOfIt) {
    auto numbers = ggx_numbers(0.3f, 0.5f, {1, 1, 1}, 4);
    for (float& azimuth : numbers.azimuths) azimuth /= 3;
    EXPECT_THAT(problem_of(tensor_file_of(numbers)), HasSubstr("neither all around, nor a half or a quarter"));
}

const std::string even_file = tensor_file_of(even_numbers({0.4f, 0.2f, 0.1f}));

TEST(PbrtMeasured, IsReadOncePerFile) {
    const auto scene = read_as("scene.pbrt",
                               "WorldBegin\nMaterial \"measured\" \"string filename\" \"a.bsdf\"\nShape \"sphere\"\n"
                               "Material \"measured\" \"string filename\" \"a.bsdf\"\nShape \"sphere\"\n",
                               {{"a.bsdf", even_file}});
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("measured")));
    const auto& first = std::get<MeasuredMaterial>(scene.materials[scene.shapes[0].material].model);
    const auto& second = std::get<MeasuredMaterial>(scene.materials[scene.shapes[1].material].model);
    EXPECT_EQ(first.measured, second.measured);
    EXPECT_NEAR(first.measured->value(out, in).value.g, 0.05f, 1e-6f);
    EXPECT_FALSE(scene.materials[scene.shapes[0].material].one_sided);
}

TEST(PbrtMeasured, IsGreyWhereItCantBeRead) {
    const std::string text = "WorldBegin\nMaterial \"measured\" \"string filename\" \"a.bsdf\"\nShape \"sphere\"\n";
    const auto missing = read_as("scene.pbrt", text), damaged = read_as("scene.pbrt", text, {{"a.bsdf", "tensor"}});
    EXPECT_THAT(warnings_of(missing), HasSubstr("scene.pbrt:2: measured material 'a.bsdf': "));
    EXPECT_THAT(warnings_of(damaged), HasSubstr("the file ends early: grey is taken instead"));
    EXPECT_TRUE(std::holds_alternative<DiffuseMaterial>(missing.materials[missing.shapes[0].material].model));
    EXPECT_THAT(errors_as("scene.pbrt", "WorldBegin\nMaterial \"measured\"\n"), HasSubstr("'filename' is missing"));
}

TEST(MitsubaMeasured, IsBlackFromBehindUnlessTwoSided) {
    const std::string bsdf = "<bsdf type='measured'><string name='filename' value='a.bsdf'/></bsdf>";
    const auto scene = read_mitsuba_bsdf(bsdf, {{"a.bsdf", even_file}});
    const Material& material = scene.materials[scene.shapes[0].material];
    EXPECT_TRUE(material.one_sided);
    EXPECT_NEAR(std::get<MeasuredMaterial>(material.model).measured->value(out, in).value.r, 0.1f, 1e-6f);
    EXPECT_THAT(warnings_of(read_mitsuba_bsdf(bsdf)), HasSubstr("measured material 'a.bsdf': "));
    EXPECT_THAT(errors_of_mitsuba("<shape type='sphere'><bsdf type='measured'/></shape>"),
                HasSubstr("needs a 'filename'"));
}

}  // namespace
}  // namespace lightnet::test::measured_reader_test
