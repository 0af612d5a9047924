//! Scenes and styles of experiments, drawn by the device and by the reference renderer.

use std::cell::RefCell;
use std::ops::ControlFlow;
use std::rc::Rc;
use std::sync::Arc;

use super::experiment::{MeasureError, Subject, Truth};
use super::run::PassTimes;
use crate::config::{self, Catalog, Source, Style};
use crate::engine::exact::Exact;
use crate::engine::{self, BkbForm, BkbWords, EffectForm, Engine, Gpu, GpuError, Request, ShadowQuality};
use crate::scene::{Image, Scene};
use crate::shipped::{self, SCENES, Shipped};

/// A shipped molecule or mesh.
pub fn shipped_scene(name: &str) -> Result<Scene, MeasureError> {
    let file = SCENES.iter().find_map(|among| shipped::find(among, name));
    let file = file.ok_or_else(|| MeasureError::Content(format!("{name}: is not shipped")))?;
    scene(file.file, file.bytes)
}

/// A scene of a file in memory.
pub fn scene(file: &str, bytes: &[u8]) -> Result<Scene, MeasureError> {
    Scene::from_bytes(file, bytes).map_err(|error| MeasureError::Content(error.to_string()))
}

/// A style with its name, by which a stage knows whether it shows it already.
#[derive(Clone)]
pub struct Look {
    name: Rc<str>,
    style: Rc<Style>,
}

impl Look {
    /// The style of a text.
    pub fn of_text(name: &str, text: &str) -> Result<Look, MeasureError> {
        Look::of_file(name, &format!("{name}.json"), text.as_bytes())
    }

    /// A shipped look.
    pub fn shipped(look: &Shipped) -> Result<Look, MeasureError> {
        Look::of_file(look.name, look.file, look.bytes)
    }

    fn of_file(name: &str, file: &str, bytes: &[u8]) -> Result<Look, MeasureError> {
        let entries = engine::catalog();
        let catalog = Catalog { shaders: &entries, kinds: engine::DRAWN_KINDS };
        let style = config::load(&Source::new(file, bytes), &catalog);
        let style = style.map_err(|mistakes| MeasureError::Content(mistakes.to_string()))?;
        Ok(Look { name: Rc::from(name), style: Rc::new(style) })
    }

    /// The style.
    pub fn style(&self) -> Style {
        Style::clone(&self.style)
    }

    /// The same style without post effects.
    pub fn without_effects(&self) -> Look {
        let mut style = Style::clone(&self.style);
        style.post_effects.clear();
        style.listed_effects.clear();
        Look { name: Rc::from(format!("{} without effects", self.name)), style: Rc::new(style) }
    }

    /// The reference renderer with a scene in it.
    pub fn reference(&self, scene: &Scene) -> Exact {
        Exact::new(scene.clone(), Style::clone(&self.style), None)
    }

    /// What the reference renderer makes of a scene in it.
    pub fn exact(&self, scene: &Scene, request: Request) -> Rc<Truth> {
        let exact = self.reference(scene);
        Truth::new(move |go_on| exact.still(&request, &mut |_| go_on()).map_err(|_| MeasureError::Interrupted))
    }
}

/// What of a stage its engine shows.
type Shown = (Rc<str>, Request, ShadowQuality, Vec<EffectForm>, BkbForm);

/// A scene on the device, which cases show in styles and sizes of theirs.
pub struct Stage {
    engine: RefCell<Option<Engine>>,
    shown: RefCell<Option<Shown>>,
    gpu: Arc<Gpu>,
    scene: Scene,
}

impl Stage {
    /// A stage with a scene; nothing is built before it is shown.
    pub fn new(gpu: &Arc<Gpu>, scene: Scene) -> Rc<Stage> {
        Rc::new(Stage { engine: RefCell::new(None), shown: RefCell::new(None), gpu: Arc::clone(gpu), scene })
    }

    /// The scene in a style, as a frame that is measured.
    pub fn frame(self: &Rc<Stage>, look: &Look, request: Request) -> GpuFrame {
        let shadows = ShadowQuality::default();
        let (forms, bkb_form) = (Vec::new(), BkbForm::default());
        GpuFrame { stage: Rc::clone(self), look: look.clone(), request, shadows, forms, bkb_form }
    }
}

/// The device of a setup.
pub fn device(gpu: Option<&Arc<Gpu>>) -> Result<&Arc<Gpu>, MeasureError> {
    gpu.ok_or(MeasureError::Gpu(GpuError::NoAdapter))
}

/// A stage in one style, for one request.
pub struct GpuFrame {
    /// The scene.
    pub stage: Rc<Stage>,
    /// The style.
    pub look: Look,
    /// The size and the samples.
    pub request: Request,
    /// How fine shadows are.
    pub shadows: ShadowQuality,
    /// Forms of post effects that no style asks for.
    pub forms: Vec<EffectForm>,
    /// The form of the bucketed k-buffer, where the style asks for one.
    pub bkb_form: BkbForm,
}

impl GpuFrame {
    /// Draws a frame with all that it needs built already.
    fn warm<T>(&self, draw: impl FnOnce(&mut Engine) -> Result<T, GpuError>) -> Result<T, MeasureError> {
        let mut engine = self.stage.engine.borrow_mut();
        let mut shown = self.stage.shown.borrow_mut();
        let style = || self.look.style();
        let engine =
            engine.get_or_insert_with(|| Engine::new(Arc::clone(&self.stage.gpu), self.stage.scene.clone(), style()));
        let wanted = (Rc::clone(&self.look.name), self.request, self.shadows, self.forms.clone(), self.bkb_form);
        if shown.as_ref() != Some(&wanted) {
            engine.set_style(style());
            engine.set_shadow_quality(self.shadows);
            engine.set_forms(self.forms.clone());
            engine.set_bkb_form(self.bkb_form);
            engine.draw(&self.request, false, &mut |_| ControlFlow::Continue(()))?;
            *shown = Some(wanted);
        }
        Ok(draw(engine)?)
    }
}

impl GpuFrame {
    /// Draws one frame; returns its milliseconds by the wall clock, and those of its passes.
    ///
    /// # Errors
    /// [`MeasureError`] where it cannot be drawn.
    pub fn timed_ms(&self) -> Result<(f64, PassTimes), MeasureError> {
        self.warm(|engine| {
            let ms = engine.draw(&self.request, true, &mut |_| ControlFlow::Continue(()))?;
            Ok((ms, engine.pass_times().clone()))
        })
    }

    /// The bucketed k-buffer of the frame; none where the style asks for no such method or it is drawn in bands.
    ///
    /// # Errors
    /// [`MeasureError`] where it cannot be drawn.
    pub fn bkb_words(&self) -> Result<Option<BkbWords>, MeasureError> {
        self.warm(|engine| engine.bkb_words(&self.request))
    }
}

impl Subject for GpuFrame {
    fn frame_ms(&mut self) -> Result<f64, MeasureError> {
        self.warm(|engine| engine.draw(&self.request, false, &mut |_| ControlFlow::Continue(())))
    }

    fn pass_ms(&mut self) -> Result<Vec<(&'static str, f64)>, MeasureError> {
        self.warm(|engine| {
            engine.draw(&self.request, true, &mut |_| ControlFlow::Continue(()))?;
            Ok(engine.pass_times().clone())
        })
    }

    fn bytes(&self) -> u64 {
        let engine = self.stage.engine.borrow();
        let targets = |engine: &Engine| engine.target_bytes().iter().map(|(_, bytes)| bytes).sum::<u64>();
        engine.as_ref().map_or(0, |engine| engine.object_bytes() + targets(engine))
    }

    fn picture(&mut self) -> Result<Image, MeasureError> {
        self.warm(|engine| engine.still(&self.request))
    }
}
