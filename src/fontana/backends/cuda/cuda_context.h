// A context of our own on a device, and owners of what lives in it.
#pragma once

#include <memory>
#include <utility>

#include "backends/cuda/cuda_api.h"
#include "backends/cuda/cuda_devices.h"

namespace fontana {

// Not the primary context, which a host shares with other libraries: a fault in their kernels or ours then stops one.
class CudaContext {
 public:
    explicit CudaContext(const CudaDevice& device);
    ~CudaContext();
    CudaContext(const CudaContext&) = delete;
    CudaContext& operator=(const CudaContext&) = delete;
    CUcontext get() const { return context_; }

 private:
    CUcontext context_ = nullptr;
};

// Makes a context the calling thread's current one for the length of a block, whatever the host had before.
class CurrentContext {
 public:
    explicit CurrentContext(const CudaContext& context) : code_(cuda().cuCtxPushCurrent(context.get())) {}
    ~CurrentContext() {
        CUcontext popped = nullptr;
        if (code_ == CUDA_SUCCESS) cuda().cuCtxPopCurrent(&popped);
    }
    CurrentContext(const CurrentContext&) = delete;
    CurrentContext& operator=(const CurrentContext&) = delete;
    CUresult code() const { return code_; }

 private:
    CUresult code_;
};

// Owns an object of a context. An error on release has no remedy and is not looked at.
template <typename Handle, auto release>
class CudaObject {
 public:
    CudaObject() = default;
    CudaObject(std::shared_ptr<const CudaContext> context, Handle handle)
        : context_(std::move(context)), handle_(handle) {}
    CudaObject(CudaObject&& other) noexcept
        : context_(std::move(other.context_)), handle_(std::exchange(other.handle_, Handle{})) {}
    CudaObject& operator=(CudaObject&& other) noexcept {
        std::swap(context_, other.context_);
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~CudaObject() {
        if (!handle_) return;
        const CurrentContext current(*context_);
        (cuda().*release)(handle_);
    }
    Handle get() const { return handle_; }
    explicit operator bool() const { return handle_ != Handle{}; }

 private:
    std::shared_ptr<const CudaContext> context_;
    Handle handle_{};
};

using CudaModule = CudaObject<CUmodule, &CudaApi::cuModuleUnload>;
using CudaMemory = CudaObject<CUdeviceptr, &CudaApi::cuMemFree>;
using CudaStreamHandle = CudaObject<CUstream, &CudaApi::cuStreamDestroy>;
using CudaEvent = CudaObject<CUevent, &CudaApi::cuEventDestroy>;

}  // namespace fontana
