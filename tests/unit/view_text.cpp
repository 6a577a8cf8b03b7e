// The text of a frame of Dear ImGui, without a window or a device.
#include <cstdio>

#include <imgui.h>

static char said[4096];

static void keep(void *, const char *text)
{
    std::snprintf(said, sizeof said, "%s", text);
}

extern "C" {

void text_begin(void)
{
    unsigned char *pixels;
    int width, height;
    ImGui::CreateContext();
    ImGuiIO &io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(4000.0f, 4000.0f);
    io.DeltaTime = 0.01f;
    io.SetClipboardTextFn = keep;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    ImGui::NewFrame();
    ImGui::LogToClipboard();
    ImGui::SetNextWindowSize(ImVec2(3000.0f, 3000.0f));
    ImGui::Begin("text", nullptr, ImGuiWindowFlags_NoTitleBar);
}

const char *text_end(void)
{
    ImGui::End();
    ImGui::LogFinish();
    ImGui::Render();
    ImGui::DestroyContext();
    return said;
}
}
