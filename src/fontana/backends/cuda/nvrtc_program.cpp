#include "backends/cuda/nvrtc_program.h"

#include <algorithm>
#include <memory>

#include "backends/cuda/nvrtc_api.h"
#include "util/error.h"

namespace fontana {
namespace {

void check(nvrtcResult code, const char* call) {
    if (code == NVRTC_SUCCESS) return;
    fail(code == NVRTC_ERROR_OUT_OF_MEMORY ? FONTANA_OUT_OF_MEMORY : FONTANA_DEVICE_UNAVAILABLE,
         "the kernels cannot be compiled: " + std::string(call) + " of NVRTC " + nvrtc_version() + " failed with " +
             nvrtc_error_name(code));
}

struct ProgramDestroyer {
    void operator()(nvrtcProgram program) const { nvrtc().nvrtcDestroyProgram(&program); }
};
using ProgramOwner = std::unique_ptr<_nvrtcProgram, ProgramDestroyer>;

ProgramOwner create_program(const std::string& text) {
    nvrtcProgram program = nullptr;
    check(nvrtc().nvrtcCreateProgram(&program, text.c_str(), "fontana", 0, nullptr, nullptr), "nvrtcCreateProgram");
    return ProgramOwner(program);
}

std::string log_of(nvrtcProgram program) {
    std::size_t bytes = 0;
    if (nvrtc().nvrtcGetProgramLogSize(program, &bytes) != NVRTC_SUCCESS) return "";
    std::string log(bytes, '\0');
    if (nvrtc().nvrtcGetProgramLog(program, log.data()) != NVRTC_SUCCESS) return "";
    log.resize(std::min(log.size(), log.find('\0')));
    return log;
}

// Empty where there is no image of this kind.
std::vector<unsigned char> image_of(nvrtcProgram program, nvrtcResult (*get_size)(nvrtcProgram, std::size_t*),
                                    nvrtcResult (*get_image)(nvrtcProgram, char*), const char* call) {
    std::size_t bytes = 0;
    check(get_size(program, &bytes), call);
    std::vector<unsigned char> image(bytes);
    if (bytes > 0) check(get_image(program, reinterpret_cast<char*>(image.data())), call);
    return image;
}

}  // namespace

CompiledImages compile_with_nvrtc(const std::string& text, const std::vector<std::string>& options) {
    const ProgramOwner program = create_program(text);
    std::vector<const char*> words;
    for (const std::string& option : options) words.push_back(option.c_str());
    const nvrtcResult code = nvrtc().nvrtcCompileProgram(program.get(), static_cast<int>(words.size()), words.data());
    CompiledImages images;
    images.is_refused = code == NVRTC_ERROR_COMPILATION;
    if (images.is_refused) {
        images.log = log_of(program.get());
        return images;
    }
    check(code, "nvrtcCompileProgram");
    images.machine_code = image_of(program.get(), nvrtc().nvrtcGetCUBINSize, nvrtc().nvrtcGetCUBIN, "nvrtcGetCUBIN");
    images.ptx = image_of(program.get(), nvrtc().nvrtcGetPTXSize, nvrtc().nvrtcGetPTX, "nvrtcGetPTX");
    return images;
}

}  // namespace fontana
