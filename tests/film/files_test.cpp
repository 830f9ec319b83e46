// Pictures in files: the same bytes, the exact sum, and never half a file.
#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>

#include "core/base/atomic_file.hpp"
#include "core/base/error.hpp"
#include "core/film/exr.hpp"
#include "core/film/png.hpp"
#include "tests/film/pictures.hpp"

namespace {
std::atomic<int> looks_at_the_mask{0};
}

// In place of the system's, so that calls are seen.
extern "C" mode_t umask(mode_t mask) noexcept {
    ++looks_at_the_mask;
    return static_cast<mode_t>(::syscall(SYS_umask, mask));
}

namespace lightnet::files_test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> names_in(const Folder& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        names.push_back(entry.path().filename());
    return names;
}

bool same_bits(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    return a.size() == b.size() && !std::memcmp(a.data(), b.data(), a.size() * sizeof(Rgb));
}

TEST(Exr, ReadsBackWhatItWrote) {
    const Folder folder;
    const Picture picture = noisy_picture(33, 17);
    write_exr(folder / "x.exr", picture);
    EXPECT_TRUE(read_exr(folder / "x.exr") == picture);
}

TEST(Exr, HoldsWhatIsShownBesideTheSum) {
    const Folder folder;
    Picture picture;
    picture.width = 2, picture.height = 1;
    picture.layers = {{"emission", {{1, 0, 0}, {0, 1, 0}}}};
    picture.shown = {{"photons", {{5, 5, 5}, {0, 0, 7}}}};
    picture.beauty = sum_of(picture.layers);
    write_exr(folder / "x.exr", picture);
    EXPECT_TRUE(read_exr(folder / "x.exr") == picture);
}

TEST(Exr, HoldsWhatCompositingNeeds) {
    const Folder folder;
    Picture picture = for_compositing();
    for (const auto& compression : lossless_compressions())
        for (const bool half : {false, true}) {
            picture.storage = {compression, half};
            if (half) round_to_half(picture.shown[0].pixels);
            write_exr(folder / "x.exr", picture);
            EXPECT_TRUE(read_exr(folder / "x.exr") == picture) << compression;
        }
}

// Key, names and values as the specification of Cryptomatte 1.2 has them; the key is how the hash of the name begins.
TEST(Exr, NamesMattesAsCryptomatteDoes) {
    const Folder folder;
    write_exr(folder / "x.exr", for_compositing());
    const Imf::InputFile file((folder / "x.exr").c_str());
    const auto said = [&](const char* what) {
        const auto name = std::string("cryptomatte/3ae39a5/") + what;
        const auto* text = file.header().findTypedAttribute<Imf::StringAttribute>(name.c_str());
        return text ? text->value() : "nothing";
    };
    EXPECT_EQ(said("name"), "CryptoObject");
    EXPECT_EQ(said("hash"), "MurmurHash3_32");
    EXPECT_EQ(said("conversion"), "uint32_to_float32");
    EXPECT_EQ(said("manifest"), R"({"ball":"deadbeef"})");
    for (const char* channel : {"CryptoObject00.R", "CryptoObject00.A", "CryptoObject01.G", "A"}) {
        const auto* found = file.header().channels().findChannel(channel);
        ASSERT_TRUE(found) << channel;
        EXPECT_EQ(found->type, Imf::FLOAT) << channel;
    }
    EXPECT_FALSE(file.header().channels().findChannel("CryptoObject02.R"));
}

TEST(Exr, NamesChannelsAsCompositorsExpectThem) {
    const Folder folder;
    Picture picture = noisy_picture(2, 1);
    const auto grey = [](float value) { return Rgb{value, value, value}; };
    picture.shown = {{"Z", {grey(1 + 0x1p-20f), grey(2)}, {1, 1, 1}, letters_of_depths},
                     {"depth", {grey(3), grey(4)}, {1, 1, 1}, letters_of_depths},
                     {"N", {{0, 0, 1}, {1, 0, 0}}, {1, 1, 1}, letters_of_vectors},
                     {"st", {{0.25f, 0.5f, 0}, {}}, {1, 1, 1}, letters_of_uv}};
    picture.storage.half = true;
    write_exr(folder / "x.exr", picture);
    EXPECT_TRUE(read_exr(folder / "x.exr") == picture);
    const Imf::InputFile file((folder / "x.exr").c_str());
    const auto& channels = file.header().channels();
    for (const char* name : {"Z", "depth.Z", "N.X", "N.Y", "N.Z", "st.U", "st.V"})
        EXPECT_TRUE(channels.findChannel(name)) << name;
    for (const char* name : {"Z.Z", "depth.R", "N.R", "st.R", "st.B"}) EXPECT_FALSE(channels.findChannel(name)) << name;
    EXPECT_EQ(channels.findChannel("Z")->type, Imf::FLOAT) << "depths are compared";
    EXPECT_EQ(channels.findChannel("N.X")->type, Imf::HALF);
}

TEST(Exr, SaysWhichColoursItHas) {
    const Folder folder;
    write_exr(folder / "x.exr", noisy_picture(2, 1));
    const Imf::InputFile file((folder / "x.exr").c_str());
    ASSERT_TRUE(Imf::hasChromaticities(file.header()));
    const auto& found = Imf::chromaticities(file.header());
    EXPECT_EQ(found.red, Imath::V2f(0.64f, 0.33f));
    EXPECT_EQ(found.white, Imath::V2f(0.3127f, 0.3290f));
    const auto* name = file.header().findTypedAttribute<Imf::StringAttribute>("colorInteropID");
    ASSERT_TRUE(name);
    EXPECT_EQ(name->value(), "lin_rec709_scene");
}

TEST(Exr, KeepsHalfFloatsWithinTheirRange) {
    std::vector<Rgb> pixels{{1e9f, -1e9f, 1 + 0x1p-12f}};
    round_to_half(pixels);
    EXPECT_EQ(pixels[0], (Rgb{65504, -65504, 1}));
}

TEST(Exr, HoldsABeautyThatIsExactlyTheSumOfItsLayers) {
    const Folder folder;
    write_exr(folder / "x.exr", noisy_picture(64, 64));
    const Picture read = read_exr(folder / "x.exr");
    ASSERT_EQ(read.layers.size(), 3u);
    std::vector<Rgb> sum = read.layers[0].pixels;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = sum[i] + read.layers[1].pixels[i] + read.layers[2].pixels[i];
    EXPECT_TRUE(same_bits(sum, read.beauty));
}

TEST(Exr, HasTheSameBytesEachTimeAndWherever) {
    const Folder folder, elsewhere;
    const Picture picture = noisy_picture(50, 40);
    write_exr(folder / "x.exr", picture);
    write_exr(elsewhere / "another_name.exr", picture);
    EXPECT_EQ(content_of(folder / "x.exr"), content_of(elsewhere / "another_name.exr"));
    EXPECT_EQ(exr_of(picture), content_of(folder / "x.exr"));
}

TEST(Exr, SaysNothingOfWhenWhereOrByWhom) {
    const Folder folder;
    write_exr(folder / "x.exr", noisy_picture(4, 4));
    const Imf::InputFile file((folder / "x.exr").c_str());
    std::vector<std::string> attributes;
    for (auto one = file.header().begin(); one != file.header().end(); ++one) attributes.emplace_back(one.name());
    EXPECT_THAT(attributes,
                ::testing::UnorderedElementsAre("channels", "chromaticities", "colorInteropID", "compression",
                                                "dataWindow", "displayWindow", "layers", "lineOrder",
                                                "pixelAspectRatio", "screenWindowCenter", "screenWindowWidth"));
}

TEST(Exr, ShowsWhereACropLies) {
    const Folder folder;
    Picture picture = noisy_picture(4, 3);
    picture.x = 5, picture.y = 7, picture.whole_width = 20, picture.whole_height = 10;
    picture.samples = std::vector<float>(12, 64);
    write_exr(folder / "x.exr", picture);
    EXPECT_TRUE(read_exr(folder / "x.exr") == picture);
    const Imf::InputFile file((folder / "x.exr").c_str());
    EXPECT_EQ(file.header().displayWindow(), Imath::Box2i({0, 0}, {19, 9}));
    EXPECT_EQ(file.header().dataWindow(), Imath::Box2i({5, 7}, {8, 9}));
}

TEST(Exr, SaysThatItIsAPreview) {
    const Folder folder;
    Picture picture = noisy_picture(4, 3);
    picture.done = 0.25f;
    write_exr(folder / "x.exr", picture);
    EXPECT_EQ(read_exr(folder / "x.exr").done, 0.25f);
}

TEST(Exr, NeedsNoLayers) {
    const Folder folder;
    const Picture picture{2, 1, {{1, 2, 3}, {4, 5, 6}}, {}};
    write_exr(folder / "x.exr", picture);
    EXPECT_TRUE(read_exr(folder / "x.exr") == picture);
}

// A few damaged bytes, or somebody's joke, must not take gigabytes. (OpenEXR itself refuses windows of too many lines,
// as it reads where each begins.)
TEST(Exr, RefusesWindowsThatItsBytesCannotFill) {
    const Folder folder;
    Picture picture = noisy_picture(8, 4);
    picture.layers.clear();  // few channels: OpenEXR bounds the bytes of a line as well
    write_exr(folder / "x.exr", picture);
    std::ifstream in(folder / "x.exr", std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(in)), {});
    const std::string attribute("dataWindow\0box2i\0", 17);
    const std::int32_t right = 2'000'000;
    const auto corner = bytes.find(attribute) + attribute.size() + 3 * sizeof right;  // behind its size, left and top
    std::memcpy(bytes.data() + corner, &right, sizeof right);
    write_file(folder / "y.exr", bytes);
    try {
        read_exr(folder / "y.exr");
        FAIL() << "it was read";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("y.exr: is damaged: "));
        EXPECT_THAT(error.what(), HasSubstr("bytes can't be 2000001 x 4 pixels"));
    }
}

TEST(Exr, SaysWhichFileItCannotRead) {
    const Folder folder;
    write_file(folder / "x.exr", "no picture");
    try {
        read_exr(folder / "x.exr");
        FAIL() << "read something";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("x.exr: is no EXR picture"));
    }
    EXPECT_THROW(read_exr(folder / "absent.exr"), Error);
}

std::vector<std::uint8_t> decoded(const std::string& bytes, png_uint_32 format = PNG_FORMAT_RGB) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size())) << image.message;
    image.format = format;
    std::vector<std::uint8_t> values(PNG_IMAGE_SIZE(image));
    EXPECT_TRUE(png_image_finish_read(&image, nullptr, values.data(), 0, nullptr)) << image.message;
    return values;
}

TEST(Png, ClipsAndFollowsTheCurveOfSrgb) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Picture picture{3, 1, {{0, 0.0031308f, 0.18f}, {0.5f, 1, 7}, {-1, nan, 0.001f}}, {}};
    EXPECT_THAT(decoded(png_of(picture)), ::testing::ElementsAre(0, 10, 118, 188, 255, 255, 0, 0, 3));
}

TEST(Png, HasTheSamePixelsWhereItIsThereAtOnce) {
    Picture picture = noisy_picture(67, 41);
    for (const bool alpha : {false, true}) {
        const PngView view{.alpha = alpha};
        if (alpha) picture.alpha.assign(picture.beauty.size(), 0.5f);
        const auto form = alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
        EXPECT_EQ(decoded(png_of(picture, view, PngEffort::quick), form), decoded(png_of(picture, view), form));
    }
}

TEST(Png, GivesEachLevelFromItsLeastOn) {
    const auto least = least_of_levels();
    Picture picture{std::uint32_t(least.size()), 1, {}, {}};
    for (const float value : least) picture.beauty.push_back({std::nextafter(value, 0.0f), value, 0});
    const auto levels = decoded(png_of(picture));
    for (std::size_t i = 0; i < least.size(); ++i) {
        EXPECT_EQ(levels[3 * i], i);
        EXPECT_EQ(levels[3 * i + 1], i + 1);
    }
}

TEST(Png, ShowsAPictureBrighterWithoutChangingIt) {
    const Picture picture{1, 1, {{0.125f, 0.25f, 1}}, {}}, brighter{1, 1, {{0.5f, 1, 4}}, {}};
    EXPECT_EQ(png_of(picture, {2}), png_of(brighter));
    EXPECT_THAT(tone_of({}), HasSubstr("exposure 1, clipped"));
    EXPECT_THAT(tone_of({2, Tone::filmic}), HasSubstr("exposure 2^2.0, filmic"));
}

// Narkowicz's formula gives 0.2669 for 0.18, 0.8038 for 1 and more than 1, which is white, from 8 or so on.
TEST(Png, RunsIntoWhiteByAFilmicCurve) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), far = std::numeric_limits<float>::infinity();
    const Picture picture{2, 1, {{0.18f, 1, 20}, {nan, -1, far}}, {}};
    EXPECT_THAT(decoded(png_of(picture, {0, Tone::filmic})), ::testing::ElementsAre(141, 232, 255, 0, 0, 255));
}

// sRGB of 0.5 is 188; what covers half of a pixel has its own colour there, as PNG is not premultiplied.
TEST(Png, HasAnAlphaWhereItIsAskedFor) {
    Picture picture;
    picture.width = 3, picture.height = 1;
    picture.beauty = {{0.5f, 0.25f, 0}, {0.5f, 0.5f, 0.5f}, {}};
    PngView view;
    view.alpha = true;
    EXPECT_EQ(png_of(picture, view), png_of(picture)) << "the picture has none";
    picture.alpha = {1, 0.5f, 0};
    EXPECT_THAT(decoded(png_of(picture, view), PNG_FORMAT_RGBA),
                ::testing::ElementsAre(188, 137, 0, 255, 255, 255, 255, 128, 0, 0, 0, 0));
    EXPECT_THAT(decoded(png_of(picture)), ::testing::ElementsAre(188, 137, 0, 188, 188, 188, 0, 0, 0));
}

TEST(Png, HasTheSameBytesEachTime) { EXPECT_EQ(png_of(noisy_picture(20, 10)), png_of(noisy_picture(20, 10))); }

TEST(WriteFile, ReplacesAFileWhole) {
    const Folder folder;
    write_file(folder / "x", "old");
    write_file(folder / "x", "new");
    EXPECT_EQ(content_of(folder / "x"), "new");
    EXPECT_THAT(names_in(folder), ::testing::ElementsAre("x"));
}

TEST(WriteFile, GivesTheFileTheRightsOfAnyOther) {
    const Folder folder;
    const mode_t before = ::umask(022);
    write_file(folder / "x", "new");
    ::umask(before);
    struct stat about {};
    ASSERT_EQ(::stat((folder / "x").c_str(), &about), 0);
    EXPECT_EQ(about.st_mode & 0777, 0644u);
}

// A mask that is set to be looked at would let files that other threads make meanwhile have any rights.
TEST(WriteFile, LeavesTheMaskOfOtherThreadsAlone) {
    const Folder folder;
    const int before = looks_at_the_mask;
    write_file(folder / "x", "new");
    EXPECT_EQ(looks_at_the_mask, before);
}

// Runs `act` in a child whose files may have at most `limit` bytes: a disk that is full. 0: it threw Error.
int outcome_on_a_full_disk(rlim_t limit, const std::function<void()>& act) {
    const pid_t child = ::fork();
    if (child == 0) {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit files{limit, limit};
        ::setrlimit(RLIMIT_FSIZE, &files);
        try {
            act();
        } catch (const Error&) {
            ::_exit(0);
        }
        ::_exit(1);
    }
    int status = -1;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(WriteFile, LeavesTheOldPictureWholeWhenTheDiskIsFull) {
    const Folder folder;
    const Picture picture = noisy_picture(8, 8);
    write_exr(folder / "x.exr", picture);
    EXPECT_EQ(outcome_on_a_full_disk(4096, [&] { write_exr(folder / "x.exr", noisy_picture(128, 128)); }), 0);
    EXPECT_TRUE(read_exr(folder / "x.exr") == picture);
    EXPECT_THAT(names_in(folder), ::testing::ElementsAre("x.exr"));
}

TEST(WriteFile, SaysWhatIsWrongWithTheFolder) {
    const Folder folder;
    try {
        write_file(folder / "absent" / "x.exr", "bytes");
        FAIL() << "wrote something";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("absent/x.exr: can't be written: No such file or directory"));
    }
    EXPECT_THAT(names_in(folder), IsEmpty());
}

TEST(WriteFile, LeavesNothingBehindWhenItCannotRename) {
    const Folder folder;
    std::filesystem::create_directories(folder / "x.exr");
    write_file(folder / "x.exr" / "inside", "keeps the folder from being replaced");
    EXPECT_THROW(write_file(folder / "x.exr", "bytes"), Error);
    EXPECT_THAT(names_in(folder), ::testing::ElementsAre("x.exr"));
}

}  // namespace
}  // namespace lightnet::files_test
