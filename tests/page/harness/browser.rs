//! A Chromium process and the messages to and from it.

use serde_json::{Value, json};
use sinew::clock;
use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Mutex, MutexGuard, PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard, TryLockError};
use std::time::Duration;

/// Seconds to wait for the answer to anything that should be answered at once.
pub const PATIENCE: f64 = 60.0;

/// How the browser may draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Backend {
    /// WebGPU on a software adapter.
    WebGpu,
    /// No WebGPU at all: the page has to fall back.
    WebGl2,
}

impl Backend {
    /// Short name, for files.
    pub fn name(self) -> &'static str {
        match self {
            Self::WebGpu => "webgpu",
            Self::WebGl2 => "webgl2",
        }
    }
}

/// How many pages may be open at a time. Each has browsers of its own, so that nothing is shared but the machine.
const PLACES: usize = 4;

/// Held by everything that is open; one who wants the machine alone holds it against all others.
static MACHINE: RwLock<()> = RwLock::new(());

/// A place in which one page can be open at a time, and its browsers, one for each backend, once started.
pub struct Place {
    number: usize,
    browsers: [Option<Browser>; 2],
}

impl Place {
    /// The browser of a backend, started if it is not running.
    pub fn browser(&mut self, backend: Backend) -> &mut Browser {
        self.browsers[backend as usize].get_or_insert_with(|| Browser::start(backend, self.number))
    }

    /// Another for every place, for the names of folders.
    pub fn number(&self) -> usize {
        self.number
    }
}

/// A place for as long as this is kept. The place goes back before the machine does.
pub struct Lease {
    /// The place.
    pub place: MutexGuard<'static, Place>,
    _others: Others,
}

/// What others may do meanwhile.
enum Others {
    Run { _guard: RwLockReadGuard<'static, ()> },
    Wait { _guard: RwLockWriteGuard<'static, ()> },
}

impl Lease {
    /// Waits for a free place; `alone` also until nothing else is open, and keeps it so: for what measures time.
    pub fn take(alone: bool) -> Self {
        static ALL: [Mutex<Place>; PLACES] =
            [const { Mutex::new(Place { number: 0, browsers: [None, None] }) }; PLACES];
        // A test that failed while it held a place closed its tab on the way out.
        let others = if alone {
            Others::Wait { _guard: MACHINE.write().unwrap_or_else(PoisonError::into_inner) }
        } else {
            Others::Run { _guard: MACHINE.read().unwrap_or_else(PoisonError::into_inner) }
        };
        loop {
            for (number, place) in ALL.iter().enumerate() {
                let mut place = match place.try_lock() {
                    Ok(place) => place,
                    Err(TryLockError::Poisoned(place)) => place.into_inner(),
                    Err(TryLockError::WouldBlock) => continue,
                };
                place.number = number;
                return Self { place, _others: others };
            }
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

/// A running Chromium. It ends by itself when this program does, because its pipe closes.
pub struct Browser {
    input: ChildStdin,
    messages: Receiver<Value>,
    events: VecDeque<Value>,
    last: u64,
    process: Child,
}

/// What every start needs: no window, no first-run pages, no calls home.
const ARGUMENTS: &[&str] = &[
    "--remote-debugging-pipe",
    "--headless=new",
    "--disable-quic",
    "--no-first-run",
    "--no-default-browser-check",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-default-apps",
    "--disable-extensions",
    "--disable-sync",
    "--disable-dev-shm-usage",
    "--disable-background-timer-throttling",
    "--disable-backgrounding-occluded-windows",
    "--disable-renderer-backgrounding",
    "--hide-scrollbars",
    "--mute-audio",
    "--force-color-profile=srgb",
    // All tabs of the page run in the process that has its wasm compiled: see `Browser::keep_compiled`.
    "--process-per-site",
];

/// WebGPU without a graphics card. With only some of these there is an adapter, but the canvas stays blank.
const WEBGPU: &[&str] = &[
    "--enable-unsafe-webgpu",
    "--use-webgpu-adapter=swiftshader",
    "--use-angle=swiftshader",
    "--enable-features=Vulkan",
    "--use-vulkan=swiftshader",
];

/// WebGL2 without a graphics card, and no WebGPU.
const WEBGL2: &[&str] = &["--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--disable-features=WebGPUService"];

impl Browser {
    fn start(backend: Backend, place: usize) -> Self {
        let profile = fresh_profile(backend, place);
        // The browser reads its protocol from descriptor 3 and writes it to 4; the shell puts our pipe there.
        let mut command = Command::new("sh");
        command.args(["-c", r#"exec "$0" "$@" 3<&0 4>&1 </dev/null >/dev/null"#]).arg(program());
        command.args(ARGUMENTS).arg(format!("--user-data-dir={}", profile.display()));
        command.args(if backend == Backend::WebGpu { WEBGPU } else { WEBGL2 });
        if is_root() {
            command.arg("--no-sandbox");
        }
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut process = command.spawn().expect("a shell is there");
        let input = process.stdin.take().expect("its input is a pipe");
        let output = process.stdout.take().expect("its output is a pipe");
        let (sender, messages) = channel();
        std::thread::spawn(move || {
            for message in BufReader::new(output).split(0) {
                let Ok(Ok(message)) = message.map(|bytes| serde_json::from_slice(&bytes)) else { return };
                if sender.send(message).is_err() {
                    return;
                }
            }
        });
        let mut browser = Self { input, messages, events: VecDeque::new(), last: 0, process };
        browser.keep_compiled();
        browser
    }

    /// Has the page's wasm compiled in a tab that stays open. Every tab of the page runs in its process and finds there what
    /// the tabs before it have compiled and optimised, which otherwise each would do again.
    fn keep_compiled(&mut self) {
        let (tab, session) = self.open_tab(None);
        // A text, not the page: it only has to come from where the page does.
        let address = served() + "www/wasm.js";
        self.call("Page.navigate", json!({ "url": address }), Some(&session));
        let compile = "Promise.all(['page', 'worker'].map((name) =>
            WebAssembly.compileStreaming(fetch(new URL(`../pkg/${name}_bg.wasm`, location.href)))))
            .then((all) => { window.kept = all; return all.length; })";
        let parameters = json!({ "expression": compile, "awaitPromise": true });
        let answer = self.call("Runtime.evaluate", parameters, Some(&session));
        assert_eq!(answer["result"]["value"], 2, "the wasm at {address} does not compile in tab {tab}: {answer}");
        self.call("Target.detachFromTarget", json!({ "sessionId": session }), None);
    }

    /// Opens an empty tab, with all others or in a context of its own, which shares nothing with them. Returns the names of
    /// the tab and of a session in it.
    pub fn open_tab(&mut self, context: Option<&str>) -> (String, String) {
        let mut place = json!({ "url": "about:blank" });
        if let Some(context) = context {
            place["browserContextId"] = json!(context);
        }
        let tab = self.call("Target.createTarget", place, None)["targetId"].take();
        let attach = json!({ "targetId": tab, "flatten": true });
        let session = self.call("Target.attachToTarget", attach, None)["sessionId"].take();
        let name = |value: Value| value.as_str().expect("the browser names what it opens").to_owned();
        (name(tab), name(session))
    }

    /// Calls a method, in a session if one is given, and returns its result. An error of the protocol fails the test.
    pub fn call(&mut self, method: &str, parameters: Value, session: Option<&str>) -> Value {
        match self.try_call(method, parameters, session, PATIENCE) {
            Ok(result) => result,
            Err(error) => panic!("the browser refused {method}: {error}"),
        }
    }

    /// The same for what may rightly fail, such as code that runs while the page goes elsewhere, waiting no longer
    /// than the given seconds.
    pub fn try_call(
        &mut self,
        method: &str,
        parameters: Value,
        session: Option<&str>,
        seconds: f64,
    ) -> Result<Value, String> {
        let id = self.send(method, parameters, session);
        let deadline = clock::seconds() + seconds;
        loop {
            let Some(mut message) = self.receive(deadline) else {
                return Err(format!("no answer in {seconds} seconds"));
            };
            if message["id"] == json!(id) {
                return match message.get("error") {
                    Some(error) => Err(error.to_string()),
                    None => Ok(message["result"].take()),
                };
            }
            if message.get("id").is_none() {
                self.events.push_back(message);
            }
        }
    }

    /// Calls a method and does not wait for its answer.
    pub fn send(&mut self, method: &str, parameters: Value, session: Option<&str>) -> u64 {
        self.last += 1;
        let mut message = json!({ "id": self.last, "method": method, "params": parameters });
        if let Some(session) = session {
            message["sessionId"] = json!(session);
        }
        let mut bytes = message.to_string().into_bytes();
        bytes.push(0);
        if self.input.write_all(&bytes).is_err() {
            panic!("the browser has ended: {:?}", self.process.try_wait());
        }
        self.last
    }

    /// What has happened since this was last asked: waits up to `seconds` for something if nothing has.
    pub fn events(&mut self, seconds: f64) -> Vec<Value> {
        let deadline = clock::seconds() + seconds;
        while let Some(message) = self.receive(if self.events.is_empty() { deadline } else { 0.0 }) {
            if message.get("id").is_none() {
                self.events.push_back(message);
            }
        }
        self.events.drain(..).collect()
    }

    /// Hears everything that happens in a session, and lets it go on if it waits for that. A worker is held at its
    /// start until it is listened to, so that nothing it does goes unheard.
    fn listen(&mut self, session: &str) {
        for method in ["Runtime.enable", "Log.enable", "Network.enable", "Inspector.enable"] {
            self.send(method, json!({}), Some(session));
        }
        let workers = json!({ "autoAttach": true, "waitForDebuggerOnStart": true, "flatten": true });
        self.send("Target.setAutoAttach", workers, Some(session));
        self.send("Runtime.runIfWaitingForDebugger", json!({}), Some(session));
    }

    /// The next message, if one comes before the deadline.
    fn receive(&mut self, deadline: f64) -> Option<Value> {
        let left = Duration::from_secs_f64((deadline - clock::seconds()).max(0.0));
        match self.messages.recv_timeout(left) {
            Ok(message) => {
                if message["method"] == "Target.attachedToTarget"
                    && let Some(session) = message["params"]["sessionId"].as_str()
                {
                    self.listen(session);
                }
                Some(message)
            }
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => panic!("the browser has ended: {:?}", self.process.try_wait()),
        }
    }
}

/// An empty folder for what the browser keeps. Those of runs before are removed; a browser of theirs that is still
/// on its way out has a folder of its own.
fn fresh_profile(backend: Backend, place: usize) -> PathBuf {
    let scratch = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let start = format!("chromium-{}-{place}-", backend.name());
    for entry in std::fs::read_dir(scratch).into_iter().flatten().flatten() {
        if entry.file_name().to_string_lossy().starts_with(&start) {
            // What cannot be removed yet is removed by a later run.
            let _ = std::fs::remove_dir_all(entry.path());
        }
    }
    scratch.join(format!("{start}{}", std::process::id()))
}

/// Where the page is served.
pub fn served() -> String {
    std::env::var("SINEW_PAGE")
        .expect("SINEW_PAGE is not set: these tests need the built page on a server; `cargo xtask test` does all that")
}

/// The browser to run: the variable `CHROMIUM`, or the first of the usual names on the path.
fn program() -> PathBuf {
    if let Some(program) = std::env::var_os("CHROMIUM") {
        return program.into();
    }
    let path = std::env::var_os("PATH").unwrap_or_default();
    let names = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];
    let found = names.iter().find_map(|name| {
        std::env::split_paths(&path).map(|folder| folder.join(name)).find(|program| program.is_file())
    });
    found.expect("Chromium is missing: install your system's packages `chromium` and `chromium-driver`")
}

/// Whether this is the superuser, for whom Chromium refuses to start inside its sandbox.
fn is_root() -> bool {
    Command::new("id").arg("-u").output().is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}
