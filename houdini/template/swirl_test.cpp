// The node on the double of the HDK: not Houdini, but the same source. `swirl_test SOP_Swirl.so cpu opencl`; a backend
// that is named must be there. Prints a line for each failure; the exit status is 0 if all holds.
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <GU/GU_Detail.h>
#include <hdk_double/hdk_double.h>

namespace {

int failures = 0;

void expect(bool holds, const std::string& what) {
    if (holds) return;
    ++failures;
    std::printf("fails: %s\n", what.c_str());
}

constexpr int k_side = 60;
constexpr double k_radius = 0.7, k_turn = 2.0, k_centre[2] = {0.1, -0.2};

// Points in a square, with gaps: every seventh was deleted.
void make_points(GU_Detail& detail, fpreal) {
    const GA_Offset first = detail.appendPointBlock(k_side * k_side);
    for (GA_Offset k = 0; k < k_side * k_side; ++k) {
        const auto column = static_cast<float>(k % k_side), row = static_cast<float>(k / k_side);
        detail.setPos3(first + k, UT_Vector3(column / 30.0f - 1.0f, 0.25f, row / 30.0f - 1.0f));
    }
    for (GA_Offset k = 0; k < k_side * k_side; k += 7) detail.destroyPointOffset(first + k);
}

// The vortex turns each circle as a whole, so where a point ends is known.
UT_Vector3 exact(const UT_Vector3& from) {
    const double x = from.x() - k_centre[0], z = from.z() - k_centre[1];
    const double turn = k_turn / (1.0 + (x * x + z * z) / (k_radius * k_radius));
    return {static_cast<float>(k_centre[0] + x * std::cos(turn) + z * std::sin(turn)), from.y(),
            static_cast<float>(k_centre[1] + z * std::cos(turn) - x * std::sin(turn))};
}

double largest_error(const std::vector<UT_Vector3>& found, const std::vector<UT_Vector3>& from) {
    double largest = 0.0;
    for (std::size_t k = 0; k < from.size(); ++k) {
        const UT_Vector3 wanted = exact(from[k]);
        for (unsigned c = 0; c < 3; ++c)
            largest = std::fmax(largest, std::fabs(static_cast<double>(found[k](c)) - static_cast<double>(wanted(c))));
    }
    return largest;
}

struct Nodes {
    hdk_double::Network network;
    SOP_Node& source = network.create_geometry("points", make_points);
    SOP_Node& swirl = network.create("template::swirl::1.0", "swirl");
    std::vector<UT_Vector3> from;

    explicit Nodes(const std::string& device) {
        from = hdk_double::positions(hdk_double::cook(source, 1.0));
        swirl.setInput(0, &source);
        swirl.setString(device, CH_STRING_LITERAL, "device", 0, 0.0);
        swirl.setFloat("angle", 0, 0.0, k_turn * 180.0 / 3.14159265358979323846);
        swirl.setFloat("radius", 0, 0.0, k_radius);
        swirl.setFloat("centre", 0, 0.0, k_centre[0]);
        swirl.setFloat("centre", 2, 0.0, k_centre[1]);
    }
    std::vector<UT_Vector3> cook() { return hdk_double::positions(hdk_double::cook(swirl, 1.0)); }
};

void check_result(const std::string& device) {
    Nodes nodes(device);
    nodes.swirl.setInt("steps", 0, 0.0, 16);
    const double coarse = largest_error(nodes.cook(), nodes.from);
    nodes.swirl.setInt("steps", 0, 0.0, 64);
    const double fine = largest_error(nodes.cook(), nodes.from);
    expect(nodes.swirl.messages().empty(), device + ": no messages");
    expect(coarse < 5e-3 && fine < 3e-4, device + ": the points are where the exact vortex has them");
    expect(coarse > 12.0 * fine, device + ": four times the steps, a sixteenth of the error");
}

void check_interrupt(const std::string& device) {
    Nodes nodes(device);
    hdk_double::interrupt_after(5);
    const std::vector<UT_Vector3> kept = nodes.cook();
    expect(kept == nodes.from, device + ": Esc leaves the points where they were");
    expect(nodes.swirl.error() == UT_ERROR_WARNING, device + ": and says so");
    hdk_double::interrupt_after(-1);
    nodes.swirl.forceRecook();
    expect(nodes.cook() != nodes.from && nodes.swirl.messages().empty(), device + ": the next cook goes through");
}

void expect_error(Nodes& nodes, const std::string& part) {
    nodes.cook();
    const auto& messages = nodes.swirl.messages();
    expect(nodes.swirl.error() == UT_ERROR_ABORT && messages.front().text.find(part) != std::string::npos,
           "an error on the node that says " + part);
}

void check_trouble() {
    Nodes nodes("a quantum computer");
    expect_error(nodes, "a quantum computer");
    nodes.swirl.setString("cpu", CH_STRING_LITERAL, "device", 0, 0.0);
    nodes.swirl.setInt("steps", 0, 0.0, 0);
    expect_error(nodes, "Steps: expected 1 or more");
    nodes.swirl.setInt("steps", 0, 0.0, 8);
    nodes.swirl.setFloat("radius", 0, 0.0, 0.0);
    expect_error(nodes, "Radius: expected more than 0");
    nodes.swirl.setFloat("radius", 0, 0.0, 1.0);
    expect(nodes.cook() != nodes.from && nodes.swirl.messages().empty(), "and once all is well the points move");
}

void check_empty() {
    hdk_double::Network network;
    SOP_Node& source = network.create_geometry("none", [](GU_Detail&, fpreal) {});
    SOP_Node& swirl = network.create("template::swirl::1.0", "swirl");
    swirl.setInput(0, &source);
    expect(hdk_double::positions(hdk_double::cook(swirl, 1.0)).empty() && swirl.messages().empty(),
           "no points are no error");
}

}  // namespace

int main(int argument_count, char** arguments) {
    try {
        hdk_double::load_plugin(arguments[1]);
        for (int k = 2; k < argument_count; ++k) {
            check_result(arguments[k]);
            check_interrupt(arguments[k]);
        }
        check_trouble();
        check_empty();
    } catch (const std::exception& trouble) {
        std::printf("error: %s\n", trouble.what());
        return 2;
    }
    return failures == 0 ? 0 : 1;
}
