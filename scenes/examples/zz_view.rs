//! probe: CPU ray caster
use glam::*;
use obvhs::{BvhBuildParams, cwbvh::builder::build_cwbvh_from_tris, ray::{Ray,RayHit}, triangle::Triangle};
use rayon::prelude::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let s = scenes::open(&a[1]).unwrap();
    let frames: Vec<u32> = a[3].split(',').map(|x| x.parse().unwrap()).collect();
    let (w, h) = (640usize, 360usize);
    let mut tris = vec![]; let mut info = vec![];
    for i in &s.instances { let m=&s.meshes[i.mesh as usize]; let x=s.models[i.model as usize].object_to_world; let n=Mat3::from_mat4(x).inverse().transpose();
        for c in m.indices.chunks_exact(3) { let v=[0,1,2].map(|k| m.vertices[c[k] as usize]); let p=v.map(|v| x.transform_point3(v.position.into()));
            tris.push(Triangle{v0:p[0].into(),v1:p[1].into(),v2:p[2].into()}); info.push((v.map(|v| (n*Vec3::from(v.normal)).normalize()), v.map(|v| Vec2::from(v.uv)), v.map(|v| Mat3::from_mat4(x)*Vec4::from(v.tangent).truncate()), m.material)); } }
    let bvh = build_cwbvh_from_tris(&tris, BvhBuildParams::very_fast_build(), &mut Default::default());
    let cast = |o: Vec3, d: Vec3, m: f32| { let r=Ray::new(o.into(), d.into(), 1e-3, m); let mut hit=RayHit::none(); bvh.ray_traverse(r,&mut hit,|r,i| tris[bvh.primitive_indices[i] as usize].intersect(r)); if hit.t.is_finite() {Some((hit.t, bvh.primitive_indices[hit.primitive_id as usize] as usize))} else {None} };
    let tex = |t: &scenes::TextureRef, uv: Vec2| { let im=&s.images[t.image as usize]; let uv=t.uv_transform.transform_point2(uv); let f=uv-uv.floor(); let x=((f.x*im.width as f32) as u32).min(im.width-1); let y=((f.y*im.height as f32) as u32).min(im.height-1); let k=((y*im.width+x)*4) as usize; Vec4::new(im.rgba[k] as f32,im.rgba[k+1] as f32,im.rgba[k+2] as f32,im.rgba[k+3] as f32)/255.0 };
    let diag = s.core_bounds.diagonal();
    for fr in frames {
        let pose = match a.get(4) { Some(p) => { let v: Vec<f32>=p.split(',').map(|x| x.parse().unwrap()).collect(); scenes::Pose::new(Vec3::new(v[0],v[1],v[2]),Vec3::new(v[3],v[4],v[5])) } None => s.path.pose(fr, 1200) };
        let inv = pose.world_to_view().inverse();
        let mut px = vec![0u8; w*h*3];
        px.par_chunks_mut(3).enumerate().for_each(|(i,o)| {
            let (x,y)=(i%w,i/w); let t=(30f32).to_radians().tan();
            let d=inv.transform_vector3(Vec3::new(((x as f32+0.5)/w as f32*2.0-1.0)*t*w as f32/h as f32,(1.0-(y as f32+0.5)/h as f32*2.0)*t,-1.0)).normalize();
            let mut c=Vec3::new(0.5,0.65,0.9);
            if let Some((t,k))=cast(pose.eye,d,1e9) { let p=pose.eye+d*t; let (ns,uvs,ts,mi)=&info[k]; let m=&s.materials[*mi as usize];
                let tr=&tris[k]; let g=Vec3::from(tr.compute_normal()); let (e0,e1,ep)=(Vec3::from(tr.v1-tr.v0),Vec3::from(tr.v2-tr.v0),p-Vec3::from(tr.v0)); let (d00,d01,d11,d20,d21)=(e0.dot(e0),e0.dot(e1),e1.dot(e1),ep.dot(e0),ep.dot(e1)); let den=d00*d11-d01*d01; let v=(d11*d20-d01*d21)/den; let ww=(d00*d21-d01*d20)/den; let u=1.0-v-ww;
                let mut n=(ns[0]*u+ns[1]*v+ns[2]*ww).normalize(); let uv=uvs[0]*u+uvs[1]*v+uvs[2]*ww;
                let back = g.dot(d)>0.0 && !m.double_sided; if g.dot(d)>0.0 { n=-n; }
                if let Some(t)=&m.normal_texture { let q=tex(t,uv)*2.0-1.0; let tg=(ts[0]*u+ts[1]*v+ts[2]*ww).normalize(); let b=n.cross(tg); n=(tg*q.x+b*q.y+n*q.z).normalize(); }
                let mut base=m.base_color.truncate(); if let Some(t)=&m.base_color_texture { let q=tex(t,uv).truncate(); base*=Vec3::new(q.x.powf(2.2),q.y.powf(2.2),q.z.powf(2.2)); }
                let sun=Vec3::new(0.4,0.8,0.3).normalize(); let off=p+n*diag*1e-4; let sh=if cast(off,sun,1e9).is_some(){0.0}else{1.0};
                let mut ao=0.0; for q in 0..6 { let an=(i*7+q*13) as f32*2.399; let hh=((q as f32+0.5)/6.0).sqrt(); let tt=n.any_orthonormal_vector(); let bb=n.cross(tt); let dd=(tt*an.cos()*hh+bb*an.sin()*hh+n*(1.0-hh*hh).sqrt()).normalize(); if cast(off,dd,diag*0.25).is_none(){ao+=1.0/6.0;} }
                let r=(d-n*2.0*d.dot(n)).normalize(); let spec=((r.dot(sun)).max(0.0)).powf(2.0/(m.roughness.max(0.05)).powi(4))*sh*(1.0-m.roughness);
                c=base*(Vec3::new(1.0,0.95,0.85)*1.6*sh*n.dot(sun).max(0.0)+Vec3::new(0.55,0.6,0.75)*(0.15+0.6*ao)*(0.6+0.4*n.y))+m.emissive*0.5+Vec3::splat(spec*0.5);
                if m.roughness<0.35 { if let Some((_,k2))=cast(off,r,1e9) { let q=s.materials[info[k2].3 as usize].base_color.truncate()*0.3; c=c.lerp(q,0.2);} else {c=c.lerp(Vec3::new(0.5,0.65,0.9),0.2+0.4*m.metallic);} }
                if back { c=Vec3::new(1.0,0.0,1.0); } }
            let c=c/(c*0.6+0.6); for k in 0..3 { o[k]=(c[k].clamp(0.0,1.0).powf(1.0/2.2)*255.0) as u8; }
        });
        image::save_buffer(format!("{}_{fr}.png", a[2]), &px, w as u32, h as u32, image::ColorType::Rgb8).unwrap();
        println!("{fr}: {pose:?}");
    }
}
