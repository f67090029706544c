#include "render/pilot.h"

#include <algorithm>
#include <cmath>

#include "math/hash.h"
#include "render/light_pass.h"
#include "render/parallel.h"
#include "render/plan_choice.h"

namespace dg {
namespace {

constexpr int kLeast = 3, kMost = 6;        // px: side of a pilot pixel, for pictures up to 9 MP
constexpr double kBlocks = 600;             // target number of pilot pixels for small pictures
constexpr double kMostBlocks = 1 << 18;     // limit for large pictures, which bounds the cost of the pilot
constexpr std::uint32_t kSamples = 2;       // per pilot pixel: the fewest that estimate a variance
constexpr int kPixelsPerPath = 16;
constexpr std::uint64_t kFewestPaths = 2048, kMostPaths = 1 << 18;
constexpr std::uint64_t kPathsPerTask = 1024;
constexpr int kMostRounds = 3;              // of light paths: each doubles their number while the plan is unsure
// Seeds. They do not depend on the picture's, so that all seeds of a picture have the same plan.
constexpr std::uint64_t kCameraSeed = hash64(0x9170), kLightSeed = hash64(0x9170, 1);

// Prices in rays; a ray with shading takes 350 to 750 ns. Measured on the table of
// scenes/lens_scenes/photographer.py with the cameras of bench/night.py. Rough values suffice, as the error is flat
// around the best plan.
constexpr double kSample = 0.4;             // a camera sample without its rays and its lens
constexpr double kPath = 0.4;               // a light path without its rays and its lens
constexpr double kConnected = 0.5;          // connections of a light path with bounces to the lens, per ray
constexpr double kSplat = 1.3;              // a splat without its shadow ray
constexpr double kShare = 0.5;              // MIS of a camera sample with light paths: its reprojection
constexpr double kShareOfRay = 0.7;         // MIS with bounced light paths: reverse densities, per ray
double price_of(const LensKind& lens) {     // a sample through the lens, all wavelengths
    return std::holds_alternative<ExactLens>(lens) ? 0.8 : 0.1;
}

/// Side of a block, px.
int block_side(const Sensor& sensor) {
    const double pixels = double(sensor.width) * sensor.height;
    const int side = std::clamp(int(std::sqrt(pixels / kBlocks)), kLeast, kMost);
    return std::max(side, int(std::ceil(std::sqrt(pixels / kMostBlocks))));
}

/// Settings of the picture with larger pixels.
RenderSettings coarse(const RenderSettings& picture, int side) {
    RenderSettings s = picture;
    s.window = s.hole = {};
    s.sensor.width = (picture.sensor.width + side - 1) / side;
    s.sensor.height = (picture.sensor.height + side - 1) / side;
    s.sample_begin = 0, s.sample_end = kSamples;
    s.round = {};
    s.seed = kCameraSeed;
    ShutterSettings shutter = picture.shutter.settings();
    shutter.line_time_s *= side;
    s.shutter = Shutter(shutter, s.sensor.width, s.sensor.height);
    s.light = {1, 0};
    s.technique = Technique::rest;
    return s;
}

class Pilot {
  public:
    Pilot(const Scene& scene, const Camera& camera, const RenderSettings& settings)
        : scene_(scene),
          camera_(camera),
          settings_(settings),
          side_(block_side(settings.sensor)),
          coarse_(coarse(settings, side_)),
          frame_{settings.sensor.width, settings.sensor.height},
          density_(settings.filter, frame_, {}, &settings.shutter) {
        settings_.seed = kLightSeed;
        settings_.light = {1, 1, settings.light.sky};
        settings_.technique = Technique::both;
        if (!scene.textures().empty()) cone_ = PixelCone(camera, settings.sensor);
    }

    LightPlan choose() {
        settings_.light_guide = coarse_.light_guide = std::make_shared<const LightGuide>(
            scene_, camera_, settings_.sensor, settings_.filter.radius(), settings_.light);
        const LightWeight weight(scene_, camera_, settings_.sensor, density_, settings_.light,
                                 settings_.technique, settings_.light_guide);
        if (weight.emission().empty() && !weight.bounces()) return {};
        Flights straight, bounced;
        std::vector<PilotBlock> blocks;
        for (int round = 1;; ++round) {
            fly<StraightLightPass>(weight, straight);
            if (weight.bounces()) fly<BouncedLightPass>(weight, bounced);
            if (straight.arrivals.empty() && bounced.arrivals.empty()) return {};
            if (blocks.empty()) blocks = look();
            const PilotPicture picture{blocks, coarse_.sensor.width, pixels() / double(blocks.size())};
            const PlanChoice choice =
                choose_plan(picture, straight.pilot(), bounced.pilot(), costs(straight, bounced));
            if (choice.sure || round == kMostRounds) return choice.plan;
        }
    }

  private:
    /// The light paths of one kind so far.
    struct Flights {
        std::vector<PilotArrival> arrivals;   // in the order of the paths, independent of threads
        std::uint64_t paths = 0;
        double rays = 0;

        PilotArrivals pilot() const { return {arrivals, paths}; }
        double rays_per_path() const { return paths > 0 ? rays / double(paths) : 0; }
    };
    PlanCosts costs(const Flights& straight, const Flights& bounced) const {
        const double lens = price_of(camera_.lens);
        PlanCosts costs;
        costs.straight = kPath + lens + straight.rays_per_path() * (1 + kSplat);
        costs.bounced = kPath + bounced.rays_per_path() * (1 + kConnected * lens);
        costs.camera = pixels() * (kSample + lens + rays_per_sample_);
        costs.sharing = pixels() * kShare;
        costs.sharing_bounced = pixels() * kShareOfRay * rays_per_sample_;
        return costs;
    }
    double pixels() const { return double(frame_.width) * frame_.height; }
    std::uint64_t first_paths() const {
        return std::clamp(std::uint64_t(pixels()) / kPixelsPerPath, kFewestPaths, kMostPaths);
    }

    /// Mean and variance of light that camera samples find, without the light that direct light paths would find.
    std::vector<PilotBlock> look() {
        const Sensor& sensor = coarse_.sensor;
        Film film(FilmLayout{sensor.width, sensor.height});
        const RenderCounters counters = render(scene_, camera_, film, coarse_, {});
        rays_per_sample_ = double(counters.rays) / double(std::max<std::uint64_t>(1, counters.camera_rays));
        const std::vector<float> mean = film.mean_xyz(), variance = film.variance_rgb();
        std::vector<PilotBlock> blocks(mean.size() / 3);
        for (std::size_t b = 0; b < blocks.size(); ++b) {
            blocks[b].mean = rgb_from_xyz({mean[3 * b], mean[3 * b + 1], mean[3 * b + 2]});
            blocks[b].variance =
                Vec3f{variance[3 * b], variance[3 * b + 1], variance[3 * b + 2]} * float(kSamples);
        }
        return blocks;
    }

    /// Draws light paths of one kind: the first, or as many as there are.
    template <typename LightPassKind>
    void fly(const LightWeight& weight, Flights& flights) const {
        Film nowhere(FilmLayout{1, 1});   // arrivals are logged instead of splatted
        const LightPassKind pass({scene_, camera_, nowhere, settings_, density_}, weight, cone_);
        const std::uint64_t begin = flights.paths, end = begin > 0 ? 2 * begin : first_paths();
        const std::uint64_t tasks = (end - begin + kPathsPerTask - 1) / kPathsPerTask;
        std::vector<std::vector<LoggedSplat>> found(tasks);
        std::vector<std::uint64_t> rays(tasks);
        parallel_tasks(settings_.threads, std::int64_t(tasks), [&](std::int64_t task) {
            LightPass::Workspace work;
            work.log = &found[task];
            const std::uint64_t first = begin + std::uint64_t(task) * kPathsPerTask;
            pass.draw(work, first, std::min(first + kPathsPerTask, end));
            rays[task] = work.counters.rays;
        });
        for (std::uint64_t t = 0; t < tasks; ++t) {
            for (const LoggedSplat& s : found[t])
                flights.arrivals.push_back({block_of(s.pixel), rgb_from_xyz(s.xyz), float(s.camera_over_light),
                                            s.spread, s.path});
            flights.rays += double(rays[t]);
        }
        flights.paths = end;
    }

    std::uint32_t block_of(Pixel pixel) const {
        const int x = std::clamp(pixel.x, 0, frame_.width - 1) / side_;
        const int y = std::clamp(pixel.y, 0, frame_.height - 1) / side_;
        return std::uint32_t(y) * std::uint32_t(coarse_.sensor.width) + std::uint32_t(x);
    }

    const Scene& scene_;
    const Camera& camera_;
    RenderSettings settings_;
    int side_;
    RenderSettings coarse_;
    FilmLayout frame_;
    FilmDensity density_;
    PixelCone cone_;
    double rays_per_sample_ = 0;
};

}  // namespace

LightPlan pilot(const Scene& scene, const Camera& camera, const RenderSettings& settings) {
    return Pilot(scene, camera, settings).choose();
}

}  // namespace dg
