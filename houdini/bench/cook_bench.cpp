// Times the solver node's cook on the double of the HDK beside the same frames through fontana.h alone, in turn.
//
//   fontana_cook_bench REQUEST
//
// REQUEST is a text of lines, written by `fontana bench houdini`; a line is a word and what belongs to it:
//
//   plugin PATH                      the node's plugin, built against the double
//   particles COUNT POSITION VELOCITY   files of 3 * COUNT floats
//   repeats WARM_UP AT_MOST SECONDS  frames before the timing, then pairs until there are enough or time is up
//   number NAME VALUE..., text NAME VALUE     parameters of the library
//   collider TYPE FLIP X Y Z RADIUS CUTOFF THICKNESS    for the library
//   node_number NAME COMPONENT VALUE     parameters of the node, menus as numbers, colliders among them
//
// Prints one JSON object: seconds of each pair, by the wall and of all threads, and whether both ended with the same
// positions, bit for bit.
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <CH/CH_Manager.h>
#include <GA/GA_Handle.h>
#include <GU/GU_Detail.h>
#include <hdk_double/hdk_double.h>

#include "fontana.h"

namespace {

void require(fontana_status status) {
    if (status != FONTANA_OK) throw std::runtime_error(fontana_last_error());
}

std::vector<float> read_floats(const std::string& path, std::size_t count) {
    std::vector<float> values(count);
    std::ifstream file(path, std::ios::binary);
    if (!file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(float))))
        throw std::runtime_error("cannot read " + std::to_string(count) + " floats from " + path);
    return values;
}

struct Particles {
    std::size_t count = 0;
    std::vector<float> position, velocity;
};

// The fluid through the library alone.
class Library {
 public:
    Library() { require(fontana_create(&simulation_)); }
    ~Library() { fontana_destroy(simulation_); }
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;

    void set_number(const std::string& name, const std::vector<double>& values) {
        require(fontana_set_number(simulation_, name.c_str(), values.data(), values.size()));
    }
    void set_text(const std::string& name, const std::string& text) {
        require(fontana_set_text(simulation_, name.c_str(), text.c_str()));
    }
    void add_collider(const std::vector<double>& values) {
        fontana_collider collider;
        fontana_collider_defaults(static_cast<fontana_collider_type>(static_cast<int>(values.at(0))), &collider);
        collider.flip = static_cast<int>(values.at(1));
        for (std::size_t c = 0; c < 3; ++c) collider.centre[c] = values.at(2 + c);
        collider.radius = values.at(5);
        collider.cutoff = values.at(6);
        collider.thickness = values.at(7);
        require(fontana_add_collider(simulation_, &collider, nullptr));
    }
    void add_particles(const Particles& particles) {
        require(fontana_add_particles(simulation_, particles.count, particles.position.data(),
                                      particles.velocity.data(), nullptr));
    }
    void step() {
        fontana_frame_report report;
        require(fontana_step_frame(simulation_, &report));
    }
    std::vector<float> position() {
        std::vector<float> values(3 * fontana_particle_count(simulation_));
        require(fontana_read_attribute(simulation_, "position", values.data(), values.size() * sizeof(float)));
        return values;
    }

 private:
    fontana_simulation* simulation_ = nullptr;
};

// The same fluid in the node, with a node upstream that holds the particles.
class Node {
 public:
    explicit Node(const Particles& particles)
        : source_(network_.create_geometry("particles",
                                           [&particles](GU_Detail& detail, fpreal) { fill(detail, particles); })),
          solver_(network_.create("fontana::solver::1.0", "solver")) {
        solver_.setInput(0, &source_);
    }
    SOP_Node& solver() { return solver_; }

    const GU_Detail& cook(int frame) {
        const GU_Detail& detail = hdk_double::cook(solver_, frame);
        for (const auto& message : solver_.messages())
            throw std::runtime_error("frame " + std::to_string(frame) + ": " + message.text);
        return detail;
    }

 private:
    static void fill(GU_Detail& detail, const Particles& particles) {
        const auto count = static_cast<GA_Size>(particles.count);
        const GA_Offset first = detail.appendPointBlock(count);
        const GA_RWHandleV3 velocity(detail.addFloatTuple(GA_ATTRIB_POINT, "v", 3));
        const GA_RWHandleV3 position(detail.getP());
        position.setBlock(first, count, reinterpret_cast<const UT_Vector3F*>(particles.position.data()));
        velocity.setBlock(first, count, reinterpret_cast<const UT_Vector3F*>(particles.velocity.data()));
        detail.bumpDataIdsForAddOrRemove(true, false, false);
    }

    hdk_double::Network network_;
    SOP_Node& source_;
    SOP_Node& solver_;
};

struct Repeats {
    int warm_up = 2, at_most = 10;
    double seconds = 5.0;
};

// Wall time, and the time of all threads of this process: other programs disturb the second less.
struct Taken {
    double wall = 0.0, processor = 0.0;
};

Taken clock_seconds(const std::function<void()>& work) {
    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t processor_begin = std::clock();
    work();
    const std::clock_t processor_end = std::clock();
    return {std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
            static_cast<double>(processor_end - processor_begin) / CLOCKS_PER_SEC};
}

bool same_positions(const GU_Detail& detail, const std::vector<float>& position) {
    const std::vector<UT_Vector3> points = hdk_double::positions(detail);
    return points.size() * 3 == position.size() &&
           std::memcmp(points.data(), position.data(), position.size() * sizeof(float)) == 0;
}

void print_seconds(const std::string& name, const std::vector<Taken>& taken, double Taken::* which) {
    std::printf("\"%s\": [", name.c_str());
    for (std::size_t k = 0; k < taken.size(); ++k) std::printf("%s%.9g", k ? ", " : "", taken[k].*which);
    std::printf("], ");
}

void print_taken(const std::string& name, const std::vector<Taken>& taken) {
    print_seconds(name + "_seconds", taken, &Taken::wall);
    print_seconds(name + "_processor_seconds", taken, &Taken::processor);
}

// Frame 1 shows what came in; each later one is a step. Who goes first changes from pair to pair.
void measure(Node& node, Library& library, const Repeats& repeats) {
    std::vector<Taken> of_node, of_library;
    double total = 0.0;
    int frame = 1;
    node.cook(frame);
    while (static_cast<int>(of_node.size()) < repeats.at_most && (of_node.empty() || total < repeats.seconds)) {
        ++frame;
        const auto cook = [&] { node.cook(frame); };
        const auto step = [&] { library.step(); };
        Taken node_time, library_time;
        if (frame % 2) {
            node_time = clock_seconds(cook);
            library_time = clock_seconds(step);
        } else {
            library_time = clock_seconds(step);
            node_time = clock_seconds(cook);
        }
        if (frame - 1 <= repeats.warm_up) continue;
        of_node.push_back(node_time);
        of_library.push_back(library_time);
        total += node_time.wall + library_time.wall;
    }
    std::printf("{");
    print_taken("node", of_node);
    print_taken("library", of_library);
    std::printf("\"same_positions\": %s}\n", same_positions(node.cook(frame), library.position()) ? "true" : "false");
}

std::vector<double> numbers(std::istringstream& words) {
    std::vector<double> values;
    for (std::string word; words >> word;) values.push_back(std::stod(word));  // takes "inf", as a stream does not
    return values;
}

struct Request {
    Particles particles;
    Repeats repeats;
    std::vector<std::function<void(Library&)>> for_library;
    std::vector<std::function<void(SOP_Node&)>> for_node;
};

void read_line(const std::string& line, Request& request) {
    std::istringstream words(line);
    std::string word, name, text;
    words >> word;
    if (word == "plugin") {
        words >> name;
        hdk_double::load_plugin(name);
    } else if (word == "particles") {
        words >> request.particles.count >> name >> text;
        request.particles.position = read_floats(name, 3 * request.particles.count);
        request.particles.velocity = read_floats(text, 3 * request.particles.count);
    } else if (word == "repeats") {
        words >> request.repeats.warm_up >> request.repeats.at_most >> request.repeats.seconds;
    } else if (word == "number") {
        words >> name;
        request.for_library.push_back([name, values = numbers(words)](Library& it) { it.set_number(name, values); });
    } else if (word == "text") {
        words >> name >> text;
        request.for_library.push_back([name, text](Library& it) { it.set_text(name, text); });
    } else if (word == "collider") {
        request.for_library.push_back([values = numbers(words)](Library& it) { it.add_collider(values); });
    } else if (word == "node_number") {
        words >> name;
        request.for_node.push_back([name, values = numbers(words)](SOP_Node& it) {
            it.setFloat(name, static_cast<int>(values.at(0)), 0.0, values.at(1));
        });
    } else if (!word.empty()) {
        throw std::runtime_error("the request has no word '" + word + "'");
    }
}

void run(const char* path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error(std::string("cannot read ") + path);
    Request request;
    for (std::string line; std::getline(file, line);) read_line(line, request);
    Library library;
    for (const auto& set : request.for_library) set(library);
    library.add_particles(request.particles);
    Node node(request.particles);
    for (const auto& set : request.for_node) set(node.solver());
    measure(node, library, request.repeats);
}

}  // namespace

int main(int argument_count, char** arguments) {
    if (argument_count != 2) {
        std::fprintf(stderr, "usage: fontana_cook_bench REQUEST\n");
        return 2;
    }
    try {
        run(arguments[1]);
    } catch (const std::exception& trouble) {
        std::fprintf(stderr, "error: %s\n", trouble.what());
        return 1;
    }
    return 0;
}
