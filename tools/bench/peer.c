#define _GNU_SOURCE
#include "bench/peer.h"

#include <errno.h>
#include <stdarg.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "app/scene/listing.h"

static bool find_program(char *path, size_t bytes)
{
    char program[2048];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    program[length > 0 ? length : 0] = 0;
    char *slash = strrchr(program, '/');
    if (slash)
        snprintf(path, bytes, "%.*s/whit-embree", (int)(slash - program), program);
    return slash && access(path, X_OK) == 0;
}

const char *peer_why_not(const whit_scene_info *scene)
{
    char path[BENCH_PATH];
    if (!find_program(path, sizeof path))
        return "`whit-embree` is not beside whit-bench; the build makes it where Embree 3 is "
               "installed (Debian: libembree-dev)";
    return scene && scene->sphere_count ? "its side has triangles alone, not spheres" : NULL;
}

/* Waits until whit-embree ends, and gives the error. */
static whit_result lost(struct peer *peer)
{
    whit_result result = process_end(&peer->process, NULL);
    if (result == WHIT_OK)
        cli_error("`whit-embree` ended too soon");
    return result == WHIT_OK ? WHIT_ERROR_FAILED : result;
}

static whit_result read_answer(struct peer *peer, char *answer, size_t bytes, const char *word)
{
    if (!fgets(answer, (int)bytes, peer->answers))
        return lost(peer);
    if (strncmp(answer, word, strlen(word)) == 0 || strcmp(answer, "none\n") == 0)
        return cli_cancel ? WHIT_ERROR_CANCELLED : WHIT_OK;
    cli_error("`whit-embree` answers `%s`", cli_shown(answer));
    return WHIT_ERROR_FAILED;
}

static whit_result WHIT_PRINTF(4, 5)
    ask(struct peer *peer, char answer[128], const char *word, const char *format, ...)
{
    char line[1024];
    va_list args;
    va_start(args, format);
    int length = vsnprintf(line, sizeof line, format, args);
    va_end(args);
    if (send(peer->socket, line, (size_t)length, MSG_NOSIGNAL) != length)
        return lost(peer);
    return read_answer(peer, answer, 128, word);
}

whit_result peer_begin(struct peer *peer, const struct bench *bench, const whit_scene *scene,
                       const char *triangles)
{
    int ends[2];
    char answer[128], path[BENCH_PATH];
    *peer = (struct peer){.socket = -1};
    bench_file(bench, triangles, path);
    whit_result result = triangles_write(scene, 0.0, path);
    if (result != WHIT_OK)
        return result;
    if (!find_program(peer->program, sizeof peer->program) ||
        socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        cli_error("no `whit-embree`, or no socket for it: %s", strerror(errno));
        return WHIT_ERROR_MEMORY;
    }
    peer->process =
        (struct process){.program = peer->program, .folder = bench->folder, .socket = ends[1]};
    process_add(&peer->process, "whit-embree", triangles, NULL);
    peer->socket = ends[0];
    peer->answers = fdopen(ends[0], "r");
    result = peer->answers ? process_start(&peer->process) : WHIT_ERROR_MEMORY;
    close(ends[1]);
    if (result == WHIT_OK)
        result = read_answer(peer, answer, sizeof answer, "embree ");
    if (result == WHIT_OK)
        sscanf(answer, "embree %31s", peer->version);
    return result;
}

/* whit-embree ends when its input is closed. */
void peer_end(struct peer *peer)
{
    if (peer->answers)
        fclose(peer->answers);
    else if (peer->socket > 0)
        close(peer->socket);
    peer->process.is_tried = true;
    if (peer->process.pid)
        (void)!process_end(&peer->process, NULL);
    *peer = (struct peer){0};
}

whit_result peer_rays(struct peer *peer, const char *name, bool any)
{
    char answer[128];
    return ask(peer, answer, "rays ", "rays %s %s\n", name, any ? "any" : "closest");
}

whit_result peer_hits(struct peer *peer, const char *name)
{
    char answer[128];
    return ask(peer, answer, "hits ", "hits %s\n", name);
}

whit_result peer_trace(struct peer *peer, const char *way, bool back, bool coherent, double ms[2])
{
    char answer[128];
    ms[0] = ms[1] = -1.0;
    whit_result result = ask(peer, answer, "time ", "trace %s %s %s\n", way,
                             back ? "back" : "forth", coherent ? "coherent" : "scattered");
    if (result == WHIT_OK && answer[0] == 't')
        sscanf(answer, "time %lf %lf", &ms[0], &ms[1]);
    return result;
}

whit_result peer_build(struct peer *peer, const char *quality, uint32_t threads, double *ms,
                       double *bytes)
{
    char answer[128];
    whit_result result = ask(peer, answer, "built ", "build %s %u\n", quality, threads);
    if (result == WHIT_OK)
        sscanf(answer, "built %lf %lf", ms, bytes);
    return result;
}
