#include "session.h"

#include <algorithm>
#include <stdexcept>

#include "frame_keys.h"
#include "free_places.h"

namespace fontana::houdini {
namespace {

class SolverError : public std::runtime_error {
 public:
    explicit SolverError(fontana_status status) : std::runtime_error(fontana_last_error()), status_(status) {}
    fontana_status status() const { return status_; }

 private:
    fontana_status status_;
};

// A frame that is simulated again had other points than the first time.
class UpstreamEdited : public std::exception {};

void check(fontana_status status) {
    if (status == FONTANA_INTERRUPTED) throw Interrupted();
    if (status != FONTANA_OK) throw SolverError(status);
}

std::uint64_t combined(std::uint64_t a, std::uint64_t b, std::int64_t c) {
    const std::uint64_t all[] = {a, b, static_cast<std::uint64_t>(c)};
    return fontana_hash(all, sizeof all);
}

}  // namespace

std::uint64_t Session::key_of_points(const SourcePoints& points) { return key_of(points); }

CookResult Session::cook(std::int64_t frame, std::int64_t start_frame, FrameHost& host) try {
    host_ = &host;
    stop_ = false;
    if (start_frame != start_frame_) reset();
    start_frame_ = start_frame;
    const std::int64_t wanted = std::max(frame, start_frame);
    try {
        follow_edits(wanted, host);
        go_to(wanted, host);
    } catch (const Interrupted&) {
        return show_last_complete(wanted, host);
    }
    return {CookStatus::done, wanted, memory_note()};
} catch (const std::exception& error) {
    is_positioned_ = false;
    return {CookStatus::failed, frame, error.what()};
} catch (...) {
    is_positioned_ = false;
    return {CookStatus::failed, frame, "an error of unknown type"};
}

void Session::reset() {
    records_.clear();
    history_.clear();
    is_positioned_ = false;
}

void Session::follow_edits(std::int64_t frame, FrameHost& host) {
    const std::uint64_t settings_key = key_of(host.settings(frame), Keyed::no);
    steady_key_ = host.steady_points_key();
    const std::uint64_t edit_key = combined(settings_key, steady_key_, start_frame_);
    if (edit_key != edit_key_ || keys_have_changed(host)) reset();
    edit_key_ = edit_key;
    const FrameRecord* known = record(frame);
    if (!known || steady_key_) return;
    const PointsWanted wanted = frame == start_frame_ ? PointsWanted::all : PointsWanted::continuous;
    // What an input gives for a frame changes by an edit alone. Where the edit began is not known: all is simulated
    // anew.
    if (points_key_of(host.points(frame, wanted)) != known->points_key) reset();
}

bool Session::keys_have_changed(FrameHost& host) const {
    if (records_.empty()) return false;
    const FrameSettings first = host.keyed_settings(start_frame_);
    const bool any = !first.settings.empty() ||
                     std::any_of(first.colliders.begin(), first.colliders.end(), [](auto& c) { return c.is_keyed; });
    for (std::size_t k = 0; any && k < records_.size(); ++k) {
        const std::int64_t frame = start_frame_ + static_cast<std::int64_t>(k);
        if (key_of(host.keyed_settings(frame), Keyed::yes) != records_[k].keyed_key) return true;
    }
    return false;
}

// A lost device is replaced once in a cook. An edit found on the way starts over, with nothing left to differ from.
void Session::go_to(std::int64_t frame, FrameHost& host) {
    for (bool is_replaced = false;;) {
        try {
            if (records_.empty()) begin(host);
            return seek(frame, host);
        } catch (const UpstreamEdited&) {
            reset();
        } catch (const SolverError& error) {
            is_positioned_ = false;
            if (error.status() != FONTANA_DEVICE_LOST || is_replaced) throw;
            is_replaced = true;
            simulation_.reset();
        }
    }
}

void Session::seek(std::int64_t frame, FrameHost& host) {
    const std::int64_t nearest = history_.nearest(frame);
    if (!is_positioned_ || position_ > frame || position_ < nearest) restore(nearest, host);
    cook_from_ = position_;
    cook_to_ = frame;
    while (position_ < frame) advance(host);
}

void Session::begin(FrameHost& host) {
    const FrameSettings settings = host.settings(start_frame_);
    const SourcePoints points = host.points(start_frame_, PointsWanted::all);
    history_.clear();
    is_positioned_ = false;
    make_simulation();
    apply(settings.settings);
    check(fontana_load_state(simulation_.get(), blank_.data(), blank_.size()));
    emit(points);
    position_ = start_frame_;
    FrameRecord record;
    record.keyed_key = key_of(settings, Keyed::yes);
    record.points_key = points_key_of(points);
    keep(std::move(record));
}

void Session::restore(std::int64_t frame, FrameHost& host) {
    is_positioned_ = false;
    make_simulation();
    apply(host.settings(frame).settings);
    const std::vector<std::byte>& state = history_.state(frame);
    check(fontana_load_state(simulation_.get(), state.data(), state.size()));
    position_ = frame;
    is_positioned_ = true;
}

// From position_ to the frame after it: the fluid moves, then the sources add to it.
void Session::advance(FrameHost& host) {
    if (stop_ || host.is_interrupted(0.0)) throw Interrupted();
    const std::int64_t next = position_ + 1;
    const FrameSettings settings = host.settings(next);
    const SourcePoints points = host.points(next, PointsWanted::continuous);
    FrameRecord record;
    record.keyed_key = key_of(settings, Keyed::yes);
    record.points_key = points_key_of(points);
    const FrameRecord* known = this->record(next);
    if (known && known->points_key != record.points_key) throw UpstreamEdited();
    is_positioned_ = false;
    apply(settings.settings);
    place_colliders(settings.colliders);
    step(host, record);
    std::vector<float> present(points.count() ? 3 * particle_count() : 0);
    if (!present.empty()) read("position", present.data(), present.size() * sizeof(float));
    if (points.count()) emit(in_free_places(points, present, 2.0 * particle_radius()));
    position_ = next;
    keep(std::move(record));
}

void Session::step(FrameHost& host, FrameRecord& record) {
    record.time = this->record(position_)->time + frame_duration();
    host_ = &host;
    check(fontana_set_progress(simulation_.get(), on_progress, this));
    const fontana_status status = step_frame_(simulation_.get(), &record.report);
    fontana_set_progress(simulation_.get(), nullptr, nullptr);
    check(status);
    record.dt_limit = record.report.dt_limit ? record.report.dt_limit : "";
    record.report.dt_limit = nullptr;  // the simulation's own text: it may change
}

int Session::on_progress(void* user, double frame_fraction) {
    const Session& session = *static_cast<Session*>(user);
    const auto done = static_cast<double>(session.position_ - session.cook_from_) + frame_fraction;
    const auto all = static_cast<double>(std::max<std::int64_t>(1, session.cook_to_ - session.cook_from_));
    return session.stop_ || session.host_->is_interrupted(done / all);
}

void Session::emit(const SourcePoints& points) {
    check(fontana_add_particles(simulation_.get(), points.count(), points.position.data(),
                                points.velocity.empty() ? nullptr : points.velocity.data(),
                                points.mass.empty() ? nullptr : points.mass.data()));
}

// The frame on the device is whole: it goes into the history.
void Session::keep(FrameRecord&& record) {
    record.particle_count = particle_count();
    const void* state = nullptr;
    std::size_t bytes = 0;
    check(fontana_save_state(simulation_.get(), &state, &bytes));
    history_.store(position_, state, bytes);
    const auto index = static_cast<std::size_t>(position_ - start_frame_);
    if (index == records_.size()) records_.push_back(std::move(record));
    is_positioned_ = true;
}

void Session::make_simulation() {
    if (simulation_) return;
    fontana_simulation* made = nullptr;
    check(fontana_create(&made));
    simulation_.reset(made);
    if (!blank_.empty()) return;
    const void* state = nullptr;
    std::size_t bytes = 0;
    // The state without particles is the same on every device; the cpu has no context to start for it.
    check(fontana_set_text(made, "solver.backend", "cpu"));
    check(fontana_save_state(made, &state, &bytes));
    const auto* first = static_cast<const std::byte*>(state);
    blank_.assign(first, first + bytes);
}

void Session::apply(const std::vector<Setting>& settings) {
    for (const Setting& setting : settings)
        check(setting.count
                  ? fontana_set_number(simulation_.get(), setting.name.c_str(), setting.numbers.data(), setting.count)
                  : fontana_set_text(simulation_.get(), setting.name.c_str(), setting.text.c_str()));
}

// Within the frame to come a centre moves in a straight line. Colliders that are gone are switched off: a simulation
// cannot lose one.
void Session::place_colliders(const std::vector<ColliderSetting>& colliders) {
    fontana_simulation* s = simulation_.get();
    const double duration = frame_duration();
    const double begin = static_cast<double>(fontana_frame(s)) * duration;
    for (std::size_t k = 0; k < colliders.size(); ++k) {
        const ColliderSetting& collider = colliders[k];
        const double* after = collider.surface.centre;
        const bool moves = !std::equal(after, after + 3, collider.centre_before.begin());
        check(k < fontana_collider_count(s) ? fontana_set_collider(s, k, &collider.surface)
                                            : fontana_add_collider(s, &collider.surface, nullptr));
        const double time[] = {begin, begin + duration};
        double centres[6];
        std::copy(collider.centre_before.begin(), collider.centre_before.end(), centres);
        std::copy(after, after + 3, centres + 3);
        check(fontana_set_collider_keys(s, k, moves ? 2 : 0, time, centres));
    }
    fontana_collider off;
    fontana_collider_defaults(FONTANA_PLANE_Y, &off);
    off.enabled = 0;
    for (std::size_t k = colliders.size(); k < fontana_collider_count(s); ++k) {
        check(fontana_set_collider_keys(s, k, 0, nullptr, nullptr));
        check(fontana_set_collider(s, k, &off));
    }
}

double Session::frame_duration() const {
    fontana_derived derived{};
    check(fontana_derive(simulation_.get(), &derived));
    return derived.frame_duration;
}

double Session::particle_radius() const {
    fontana_derived derived{};
    check(fontana_derive(simulation_.get(), &derived));
    return derived.particle_radius;
}

// After an interruption. Nothing may be there yet: then the frame is empty.
CookResult Session::show_last_complete(std::int64_t frame, FrameHost& host) {
    if (history_.is_empty()) return {CookStatus::interrupted, frame, "interrupted before the first frame was there"};
    const std::int64_t last = history_.nearest(frame);
    restore(last, host);
    return {CookStatus::interrupted, last,
            "interrupted: this is frame " + std::to_string(last) + " of " + std::to_string(frame) +
                "; cook again to go on"};
}

std::string Session::memory_note() const {
    if (history_.stride() == 1) return "";
    return "the memory limit is reached: every frame in " + std::to_string(history_.stride()) +
           " is kept, and going back simulates the others again; write the result to a File Cache";
}

std::size_t Session::particle_count() const { return fontana_particle_count(simulation_.get()); }

void Session::read(const char* attribute, void* out, std::size_t bytes) {
    check(fontana_read_attribute(simulation_.get(), attribute, out, bytes));
}

std::vector<float> Session::ages() const {
    std::vector<float> ages(particle_count());
    const double now = record(position_)->time;
    std::size_t born = 0;
    for (std::size_t k = 0; k < records_.size() && born < ages.size(); ++k)
        for (; born < std::min(records_[k].particle_count, ages.size()); ++born)
            ages[born] = static_cast<float>(now - records_[k].time);
    return ages;
}

const FrameRecord* Session::record(std::int64_t frame) const {
    const std::int64_t index = frame - start_frame_;
    return index >= 0 && index < static_cast<std::int64_t>(records_.size()) ? &records_[static_cast<std::size_t>(index)]
                                                                            : nullptr;
}

std::string Session::device_name() const {
    fontana_device device{};
    if (!is_positioned_ || fontana_device_in_use(simulation_.get(), &device) != FONTANA_OK) return "";
    return std::string(device.backend) + ": " + device.name;
}

std::uint64_t Session::device_bytes() const {
    std::uint64_t bytes = 0;
    if (is_positioned_) fontana_estimate_memory(simulation_.get(), particle_count(), &bytes);
    return bytes;
}

}  // namespace fontana::houdini
