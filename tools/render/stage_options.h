// Options of vpl-render for every integrator.
#pragma once

#include "scene/filter_spec.h"
#include "tools/common/options/option.h"

namespace bnvpl {

inline constexpr uint64_t kMinPasses = 2;  // passes that an error estimate needs
inline constexpr double kUnlimitedSpp = 0x1p32 - 1;
inline constexpr WholeOption kSppOption = inTopic(
    Topic::Main,
    countOption(
        "spp", "16", kUnlimitedSpp, "",
        "samples per pixel; with --time, --target-error or --passes an upper limit, if given"));
inline constexpr RealOption kTimeOption =
    inTopic(Topic::Speed, unrecorded(optional(durationOption(
                              "time", "as many passes over the film as fit into this time"))));
inline constexpr RealOption kTargetErrorOption = unrecorded(optional(
    inTopic(Topic::Quality,
            realOption("target-error", "", 0.0001, 10, "",
                       "render passes until the estimated error of the image is at most this"))));
inline constexpr WholeOption kPassesOption = optional(
    wholeOption("passes", "", kMinPasses, 0x1p40, "",
                "render this many passes; with --time or --target-error at most this many"));
inline constexpr Needs kPassesAreMade{isGiven(kTimeOption), isGiven(kTargetErrorOption),
                                      isGiven(kPassesOption)};
inline constexpr WholeOption kPassSppOption = optional(neededBy(
    kPassesAreMade,
    wholeOption("pass-spp", "", 1, 64, "",
                "samples per pixel in a pass, on average (default: 4; with --time 2 or 1 where ten "
                "passes of 4 would not fit)")));
inline constexpr SwitchOption kAdaptiveOption =
    neededBy(kPassesAreMade,
             switchOption("adaptive", "on",
                          "after the first passes, take more samples where the error is larger"));
inline constexpr TextOption kOnlyOption = inTopic(
    Topic::Main, choiceOption("only", "all", "all|direct|indirect", "light that the image shows"));
inline constexpr Condition kIndirectIsShown = valueIs(kOnlyOption, "all|indirect"),
                           kDirectIsShown = valueIs(kOnlyOption, "all|direct");
inline constexpr TextOption kSizeOption = unrecorded(inTopic(
    Topic::Main,
    textOption("size", "", "WIDTHxHEIGHT",
               "size of the film instead of the scene's; keeps the vertical field of view")));
inline constexpr TextOption kFilterOption = inTopic(
    Topic::Quality,
    choiceOption(
        "filter", "box", "box|gaussian|blackman-harris|mitchell",
        "pixel filter instead of the scene's; it spreads samples and photons, and albedo, N "
        "and Z are means over the samples"));
inline constexpr RealOption kFilterRadiusOption =
    optional(realOption("filter-radius", "", kMinFilterRadius, kMaxFilterRadius, "pixels",
                        "half the width of the filter; without it, box 0.5, gaussian and "
                        "blackman-harris 1.5, mitchell 2"));
inline constexpr SwitchOption kTransparentOption = inTopic(
    Topic::Files,
    switchOption(
        "transparent", "off",
        "leave the sky that camera rays see out of R, G, B; suns, too; layer A is the alpha"));
inline constexpr TextOption kCropOption =
    optional(textOption("crop", "", "X0,Y0,X1,Y1",
                        "render only columns X0 to before X1, rows Y0 to before Y1; they count "
                        "from the upper left pixel, and crops assemble into the whole image; "
                        "--integrator vpl needs --fireflies keep for it"));
inline constexpr SwitchOption kForDenoiserOption = unrecorded(inTopic(
    Topic::Quality,
    switchOption("for-denoiser", "off",
                 "noise that is independent between pixels; adds the layers denoise_albedo and "
                 "denoise_normal, and sets --reuse 1")));
inline constexpr TextOption kPixelsOption =
    choiceOption("pixels", "float", "half|float", "EXR channel type");
inline constexpr TextOption kExposureOption = unrecorded(inTopic(
    Topic::Files,
    textOption("exposure", "auto", "EV|auto", "stops of the PNG; auto: log mean to middle grey")));
// The help lists the layers.
inline constexpr OptionKey<std::string> kLayersKey{"layers"};

}  // namespace bnvpl
